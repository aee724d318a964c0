// Pattern surgery: bake, mirror, retime, concat, blend, ramp. The result is sampled and checked
// before it is written.

#include "ayumi/author/edit/edit.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/study/retime.hpp"
#include "check_table.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct EditCommand {
  std::string pattern, out;
  std::vector<std::string> patterns;  // of concat and blend
  double over = 0;                    // [s]
  Ramps ramps;
  std::vector<std::string> tolerances;
  PatternOptions input;
  double scale = 0;
  bool to_limits = false;
};

struct ForceRange {
  double least = 0, most = 0;  // [N]
};

ForceRange force_range(const CommandSeries& series) {
  const auto [least, most] =
      std::minmax_element(series.samples.begin(), series.samples.end(),
                          [](const auto& a, const auto& b) { return a.fz < b.fz; });
  return {least->fz, most->fz};
}

// The edited pattern, sampled and checked, then written with its table.
struct Result {
  CommandSeries series;
  ConsistencyReport report;
  std::string words;     ///< the report for people
  TableCaution caution;  ///< of the tables that went into it
};

Result check_edited(const Context& context, const EditCommand& options, const Task& input,
                    const Pattern& edited) {
  Result result;
  result.caution = input.caution;
  result.series = sample(input.robot, edited, {.dt = input.series.dt}, context.progress());
  result.report =
      check_consistency(input.robot, result.series, check_options(input, options.tolerances));
  result.words = check_table(result.report, input.robot);
  return result;
}

void write_edited(Context& context, const EditCommand& options, const Pattern& edited,
                  const Result& result, const std::string& words, Json json) {
  refuse_overwriting(context, options.out);
  if (edited.table) refuse_overwriting(context, table_beside(options.out));
  write_pattern_and_table(options.out, edited, {}, result.caution);
  context.print(options.out + ": " + (result.report.consistent ? "consistent" : "INCONSISTENT") +
                ", " + text::fixed(result.series.duration(), 2) + " s\n" + words + result.words);
  json["output"] = options.out;
  json["table"] = edited.table ? Json(table_beside(options.out).string()) : Json(nullptr);
  json["duration_s"] = result.series.duration();
  json["check"] = Json::parse(check_json(result.report));
  context.print_json(json.dump(2));
  context.exit_code = result.report.consistent ? 0 : 1;
}

Task load(const Context& context, const EditCommand& options) {
  refuse_unknown_tolerances(options.tolerances);
  refuse_overwriting(context, options.out);
  return load_pattern(context, options.pattern, options.input);
}

void bake(Context& context, const EditCommand& options) {
  const Task input = load(context, options);
  const Pattern edited =
      baked(input.robot, input.pattern, input.series, table_beside(options.out).string());
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json{{"rows", input.series.samples.size()}});
}

void mirror(Context& context, const EditCommand& options) {
  const Task input = load(context, options);
  const Pattern edited = mirrored(input.robot, input.pattern);
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json::object());
}

std::string in_words(double scale, const ConsistencyReport& before, const ForceRange& force_before,
                     const Result& after, const FastestPace* pace) {
  const ForceRange force = force_range(after.series);
  const auto mm = [](double metres) { return text::fixed(1e3 * metres, 1); };
  const auto newtons = [](const ForceRange& f) {
    return text::fixed(f.least, 1) + " to " + text::fixed(f.most, 1) + " N";
  };
  std::string out = "  the motion takes " + text::brief(scale) + " times its original time\n";
  if (pace)
    out += pace->bounded ? "  a faster pace fails: " + pace->limited_by + "\n"
                         : "  no limit was found down to this scale\n";
  return out + "  ZMP margin " + mm(before.summary[FindingKind::support_margin]) + " mm before, " +
         mm(after.report.summary[FindingKind::support_margin]) + " mm after; f_z " +
         newtons(force_before) + " before, " + newtons(force) + " after\n";
}

Json in_json(double scale, const ConsistencyReport& before, const ForceRange& force_before,
             const Result& after, const FastestPace* pace) {
  const ForceRange force = force_range(after.series);
  Json json = {{"scale", scale}};
  if (pace) json["limited_by"] = pace->bounded ? Json(pace->limited_by) : Json(nullptr);
  json["zmp_margin_m"] = {{"before", before.summary[FindingKind::support_margin]},
                          {"after", after.report.summary[FindingKind::support_margin]}};
  json["fz_N"] = {{"before", {force_before.least, force_before.most}},
                  {"after", {force.least, force.most}}};
  return json;
}

FastestPace limits_of(const Context& context, const EditCommand& options, const Task& input) {
  RetimeOptions retime;
  retime.check = check_options(input, options.tolerances);
  retime.dt = input.series.dt;
  FastestPace pace = fastest_pace(input.robot, input.pattern, retime, context.progress());
  if (pace.by_posture)
    fail(ErrorCode::solver, options.pattern + ": no pace passes the check: " + pace.limited_by +
                                "; the posture of the table itself is wrong, and no pace changes "
                                "it; try repair");
  if (!pace.found)
    fail(ErrorCode::solver, options.pattern + ": no time scale up to " +
                                text::brief(retime.slowest) + " passes the check: " +
                                pace.limited_by + "; more time alone is not enough; try repair");
  return pace;
}

void retime(Context& context, const EditCommand& options) {
  if (options.to_limits == (options.scale != 0))
    fail(ErrorCode::usage, "edit retime: give either --scale S or --to-limits");
  const Task input = load(context, options);
  const ConsistencyReport before =
      check_consistency(input.robot, input.series, check_options(input, options.tolerances));
  FastestPace pace;
  if (options.to_limits) pace = limits_of(context, options, input);
  const double scale = options.to_limits ? pace.scale : options.scale;
  const Pattern edited = retimed(input.robot, input.pattern, scale);
  const Result result = check_edited(context, options, input, edited);
  const ForceRange force = force_range(input.series);
  const FastestPace* const found = options.to_limits ? &pace : nullptr;
  write_edited(context, options, edited, result, in_words(scale, before, force, result, found),
               in_json(scale, before, force, result, found));
}

// Patterns one after the other; the table of what is joined so far is only in memory.
void join(Context& context, const EditCommand& options) {
  if (options.patterns.size() < 2)
    fail(ErrorCode::usage,
         "edit concat, edit blend: give at least two patterns, in the order in which they are "
         "played");
  refuse_overwriting(context, options.out);
  const std::string table = table_beside(options.out).string();
  Task input = load_pattern(context, options.patterns.front(), options.input);
  Json joins = Json::array();
  for (size_t i = 1; i < options.patterns.size(); ++i) {
    const Task next = load_pattern(context, options.patterns[i], options.input);
    if (next.robot.description().sha256 != input.robot.description().sha256)
      fail(ErrorCode::bad_pattern, options.patterns[i] + ": /robot: the robot is '" +
                                       next.pattern.robot + "', but it is '" + input.pattern.robot +
                                       "' in " + options.patterns.front());
    joins.push_back(input.series.duration());
    add_caution(input.caution, next.caution);
    input.pattern = joined(input.robot, {input.pattern, input.series}, {next.pattern, next.series},
                           options.over, table);
    input.series = sample(input.robot, input.pattern, {.dt = input.series.dt}, context.progress());
  }
  write_edited(context, options, input.pattern,
               check_edited(context, options, input, input.pattern), "", Json{{"joins_s", joins}});
}

void ramp(Context& context, const EditCommand& options) {
  if (options.ramps.in <= 0 && options.ramps.out <= 0)
    fail(ErrorCode::usage,
         "edit ramp: both --from and --back are 0; set at least one of them above 0 s");
  const Task input = load(context, options);
  const Pattern edited = ramped(input.robot, {input.pattern, input.series}, options.ramps,
                                table_beside(options.out).string());
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json{{"in_s", options.ramps.in}, {"out_s", options.ramps.out}});
}

void add_edit_options(CLI::App& command, EditCommand& options) {
  command.add_option("-o,--out", options.out, "Pattern file to write.")->required()->type_name("F");
  command
      .add_option("--tolerance", options.tolerances,
                  "Tolerance of one kind of finding; see ayumi check --tolerances.")
      ->type_name("KIND=VALUE")
      ->allow_extra_args(false);
  add_pattern_options(command, options.input);
}

CLI::App& add_join_of(CLI::App& parent, const std::string& name, const std::string& what,
                      EditCommand& options) {
  CLI::App* command = parent.add_subcommand(name, what);
  command->add_option("PATTERN", options.patterns, "Pattern files, in their order.")->required();
  add_edit_options(*command, options);
  return *command;
}

CLI::App& add_edit_of(CLI::App& parent, const std::string& name, const std::string& what,
                      EditCommand& options) {
  CLI::App* command = parent.add_subcommand(name, what);
  command->add_option("PATTERN", options.pattern, "Pattern file.")->required();
  add_edit_options(*command, options);
  return *command;
}

}  // namespace

void add_edit(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand(
      "edit",
      "change a whole pattern and check the result: bake, mirror, retime, concat, blend, "
      "ramp");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  ayumi edit mirror walk.json -o mirrored.json\n"
      "  ayumi edit retime walk.json --scale 1.25 -o slower.json\n"
      "  ayumi edit retime walk.json --to-limits -o fastest.json\n"
      "  ayumi edit bake walk.json -o baked.json\n"
      "  ayumi edit concat step.json walk.json -o both.json\n"
      "  ayumi edit blend squat.json sway.json --over 0.8 -o both.json\n"
      "  ayumi edit ramp imported.json --from 1.5 --back 1.5 -o from_home.json");
  static EditCommand options;
  add_edit_of(*command, "bake",
              "write the motion as a dense table of joint angles, COG, ZMP, f_z and base", options)
      .callback([&context] { bake(context, options); });
  add_edit_of(*command, "mirror", "exchange left and right", options).callback([&context] {
    mirror(context, options);
  });
  add_join_of(*command, "concat", "play one pattern after the other, without a pause", options)
      .callback([&context] { join(context, options); });
  CLI::App& blend_command =
      add_join_of(*command, "blend",
                  "play one pattern after the other, with a transition between them", options);
  blend_command.add_option("--over", options.over, "Duration of the transition [s].")
      ->required()
      ->check(number_within(0.02, 60.0))
      ->type_name("S");
  blend_command.callback([&context] { join(context, options); });
  CLI::App& ramp_command = add_edit_of(
      *command, "ramp", "move from a posture to the motion, and back at its end", options);
  ramp_command
      .add_option("--from", options.ramps.in,
                  "Time to move from the posture to the motion [s]; 0 = none.")
      ->check(number_within(0.0, 60.0))
      ->type_name("S")
      ->capture_default_str();
  ramp_command
      .add_option("--back", options.ramps.out, "Time to move back to the posture [s]; 0 = none.")
      ->check(number_within(0.0, 60.0))
      ->type_name("S")
      ->capture_default_str();
  ramp_command
      .add_option("--posture", options.ramps.posture, "A posture of the pattern or of the robot.")
      ->type_name("NAME")
      ->capture_default_str();
  ramp_command.callback([&context] { ramp(context, options); });
  CLI::App& retime_command =
      add_edit_of(*command, "retime", "play the same motion faster or more slowly", options);
  retime_command
      .add_option("--scale", options.scale, "Factor on the time: 0.8 is faster, 1.25 is slower.")
      ->check(number_within(0.01, 100.0))
      ->type_name("S");
  retime_command.add_flag("--to-limits", options.to_limits,
                          "Find the fastest scale that passes the check.");
  retime_command.callback([&context] { retime(context, options); });
}

}  // namespace ayumi::app
