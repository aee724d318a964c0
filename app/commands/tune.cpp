// Searches better DTAD gains for a pattern by a declared objective.

#include "ayumi/study/tune.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

struct TuneCommand {
  std::string pattern, out;
  PatternOptions input;
  std::vector<std::string> start;
  std::vector<double> times;
  TuneOptions tune;
};

Json figures_json(const TuneFigures& f) {
  return {{"objective", f.objective},
          {"recovery", f.recovery},
          {"unpushed", f.unpushed},
          {"falls", f.falls},
          {"pushes", f.pushes}};
}

Json gains_json(const std::map<std::string, double>& gains) {
  Json json = Json::object();
  for (const auto& [name, value] : gains) json[name] = value;
  return json;
}

std::string line(const std::string& label, const TuneFigures& f) {
  return "  objective " + label + ": " + text::fixed(f.objective, 4) + " = recovery " +
         text::fixed(f.recovery, 4) + " + 10 x (" + text::counted(f.falls, "fall") + " / " +
         text::counted(f.pushes, "push", "pushes") + ") + error without a push " +
         text::fixed(f.unpushed, 4) + "\n";
}

// The text of the pattern with other gains; every other byte stays the same.
std::string text_with_gains(const TuneCommand& options, const TuneResult& result) {
  std::vector<PatternEdit> edits = {
      {PatternEdit::Kind::set, "/controller/type", Json(name_of(ControllerKind::dtad)).dump()}};
  for (const auto& [name, value] : result.gains)
    edits.push_back({PatternEdit::Kind::set, "/controller/gains/" + name, Json(value).dump()});
  std::string text = edited_text(read_file(options.pattern), edits);
  pattern_of_text(text, options.out);  // the named files have to exist from the new place
  return text;
}

void tune(Context& context, TuneCommand& options) {
  if (!options.out.empty()) {
    if (options.pattern == "-")
      fail(ErrorCode::usage,
           "tune -o: standard input is read once and has no text to change. Name a file");
    refuse_overwriting(context, options.out);
  }
  const Task input = load_pattern(context, options.pattern, options.input);
  TuneOptions& t = options.tune;
  note_missing_noise(input.robot, t.simulate.sensor_noise);
  t.threads = context.threads;
  t.simulate.profile = input.profile;
  t.simulate.world = input.pattern.world;
  t.simulate.seed = context.seed;
  t.simulate.controller = {ControllerKind::dtad, {}};
  if (input.pattern.controller.type == ControllerKind::dtad)
    t.simulate.controller = input.pattern.controller;
  for (const auto& [name, value] : read_pairs(options.start, "--gain"))
    t.simulate.controller.gains.emplace_back(name, value);
  for (const double at : options.times)
    t.phases.push_back({"t = " + text::fixed(at, 3) + " s", at, false});
  const TuneResult result = tune_gains(input.robot, input.series, t, context.progress());
  std::string out = options.pattern + ": pushes of " + text::brief(t.level) +
                    " B (B = the capture bound), profile " + input.profile + "\n";
  out +=
      line("before tuning", result.before) + line("after tuning", result.after) + "  \"gains\": {";
  bool first = true;
  for (const auto& [name, value] : result.gains) {
    out += std::string(first ? " \"" : ", \"") + name + "\": " + text::brief(value);
    first = false;
  }
  out += " }\n  sets of gains tried: " + std::to_string(result.choices) +
         ". Sets that were not tried, because their loop is unstable: " +
         std::to_string(result.refused) + ". Test the result with other pushes (ayumi push)\n";
  if (!options.out.empty()) {
    write_file(options.out, text_with_gains(options, result));
    out += "  " + options.out + ": the pattern with these gains\n";
  }
  context.print(out);
  context.print_json(Json{
      {"output", options.out.empty() ? Json(nullptr) : Json(options.out)},
      {"gains", gains_json(result.gains)},
      {"start", gains_json(result.start)},
      {"before", figures_json(result.before)},
      {"after", figures_json(result.after)},
      {"level", t.level},
      {"choices", result.choices},
      {"refused_unstable",
       result.refused}}.dump(2));
}

}  // namespace

void add_tune(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("tune", "improve the gains of DTAD for a pattern by search");
  command->footer(
      "Examples:\n  ayumi tune patterns/hoap1_walk.json --profile hoap1-strong\n"
      "  ayumi tune walk.json -o tuned.json\n"
      "  ayumi tune walk.json --tune ka,tau_z --level 1.0 --directions 8 --json\n"
      "The objective is the sum of two means, and a smaller objective is better. The first "
      "mean\nis over the pushes. The value of a push is 10 if the robot falls. Otherwise, the\n"
      "value is omega / z times the integral of |DCM - commanded DCM|. The integral begins at "
      "the\npush and ends 1.2 s after the end of the push. The second mean is the mean "
      "over time of\n|ZMP - reference ZMP| / z for the pattern without a push. z is the COG "
      "height, and omega is\nthe square root of g / z. Gains that make the loop unstable are not "
      "tried.");
  auto options = std::make_shared<TuneCommand>();
  TuneOptions& t = options->tune;
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command
      ->add_option("-o,--out", options->out,
                   "Pattern file to write: PATTERN with the gains that were found.")
      ->type_name("F");
  add_pattern_options(*command, options->input);
  command
      ->add_option("--gain", options->start,
                   "Gain at the start of the search (default: the gain of the pattern).")
      ->type_name("GAIN=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--tune", t.gains,
          "Gains to change (default: ka,q,ks,kd,tau_z,ankle). docs/theory.md explains these gains.")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--level", t.level,
                   "Size of the test pushes as a multiple of the capture bound.")
      ->check(number_within(TuneOptions::kLevel).description(""))
      ->capture_default_str()
      ->type_name("X");
  command
      ->add_option("--directions", t.directions,
                   "Number of push directions, evenly spread; the first is forward.")
      ->check(whole_number_within(PushOptions::kDirections).description(""))
      ->capture_default_str()
      ->type_name("N");
  add_push_times(*command, options->times);
  command->add_option("--rounds", t.rounds, "Number of passes of the search through all gains.")
      ->check(whole_number_within(TuneOptions::kRounds).description(""))
      ->capture_default_str()
      ->type_name("N");
  add_noise_flag(*command, t.simulate.sensor_noise);
  command->callback([options, &context] { tune(context, *options); });
}

}  // namespace ayumi::app
