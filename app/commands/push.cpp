// Largest survivable impulse by gait phase and direction, compared with the open loop and the
// capture bound.

#include "ayumi/study/push.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/motion/shown_name.hpp"
#include "ayumi/plot/push_map.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "push_results.hpp"
#include "simulation.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

struct PushCommand {
  std::string pattern, out, map;
  PatternOptions input;
  std::vector<std::string> controllers, gains;
  std::vector<double> times;
  std::string plant = "ayumi";
  bool unstable = false;
  PushOptions push;
};

std::vector<ControllerSpec> chosen_controllers(const Task& input, const PushCommand& options) {
  std::vector<ControllerSpec> specs;
  for (const std::string& name : options.controllers) {
    const ControllerType type = controller_type(name);
    if (type == ControllerKind::none) continue;  // the open loop is always included
    specs.push_back({type, {}});
    if (type == input.pattern.controller.type) specs.back() = input.pattern.controller;
  }
  if (options.controllers.empty())
    specs = {input.pattern.controller.type == ControllerKind::none
                 ? ControllerSpec{ControllerKind::dtad, {}}
                 : input.pattern.controller};
  for (ControllerSpec& spec : specs) {
    for (const auto& [name, value] : read_pairs(options.gains, "--gain"))
      spec.gains.emplace_back(name, value);
    check_controller(input.robot, spec);  // throws the reason if the gains are wrong
    refuse_unstable_gains(input, spec, options.unstable);
  }
  return specs;
}

PushOptions push_options(const Context& context, const Task& input, const PushCommand& options) {
  PushOptions push = options.push;
  push.threads = context.threads;
  push.simulate.profile = input.profile;
  push.simulate.world = input.pattern.world;
  push.simulate.seed = context.seed;
  push.simulate.plant = plant_of(options.plant);
  push.controllers = chosen_controllers(input, options);
  for (double t : options.times)
    push.phases.push_back({"t = " + text::fixed(t, 3) + " s", t, false});
  if (push.phases.empty()) {
    SimulateOptions gait = push.simulate;
    for (const ControllerSpec& c : push.controllers)
      if (c.type == ControllerKind::viip && gait.controller.type != ControllerKind::viip)
        gait.controller = c;
    push.phases = default_push_phases(input.robot, input.series, gait);
  }
  return push;
}

/// The request for the results file. Results are only valid for the same request.
Json study_json(const Task& input, const PushOptions& push) {
  Json controllers = Json::array(), phases = Json::array();
  for (const ControllerSpec& c : push.controllers) {
    Json gains = Json::object();
    for (const auto& [name, value] : c.gains) gains[name] = value;
    controllers.push_back({{"type", name_of(c.type)}, {"gains", gains}});
  }
  for (const PushPhase& p : push.phases)
    phases.push_back({{"name", p.name}, {"at_s", p.at}, {"standing", p.standing}});
  return {{"version", version()},
          {"pattern_sha256", input.pattern.sha256},
          {"parameters", input.pattern.parameters},
          {"robot_sha256", input.robot.description().sha256},
          {"profile", input.profile},
          {"controllers", controllers},
          {"phases", phases},
          {"directions", push.directions},
          {"step", push.step},
          {"cap", push.cap},
          {"replicas", push.replicas},
          {"duration_s", push.duration},
          {"noise", push.simulate.sensor_noise},
          {"substeps", push.simulate.substeps},
          {"plant", push.simulate.plant.name},
          {"seed", push.simulate.seed}};
}

std::string push_cell(const std::string& text, size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string impulse_text(const PushLimit& limit) {
  return text::fixed(limit.impulse, 2) + (limit.capped ? "+" : "");
}

std::string ratio_text(const PushLimit& limit, double bound) {
  return text::fixed(bound > 0 ? limit.impulse / bound : 0, 2) + (limit.capped ? "+" : "");
}

/// One block for each phase: the limits of every law in N s, the bound B, and the limits as
/// multiples of B. There is one column for each direction.
std::string table(const std::vector<PushCase>& cases, const PushOptions& push,
                  const CommandSeries& series) {
  const std::string open = push_baseline(series);
  constexpr size_t kCell = 7;  // width of a column [characters]
  size_t label_width = open.size();
  for (const ControllerSpec& c : push.controllers)
    label_width = std::max(label_width, std::string(name_of(c.type)).size());
  label_width += std::string(" J/m, m/s ").size();
  const size_t directions = static_cast<size_t>(push.directions);
  std::string out;
  for (size_t p = 0; p < cases.size() / directions; ++p) {
    const PushCase* row = &cases[p * directions];
    // A phase that was chosen by --at has the time as its name.
    const std::string at = text::fixed(row->phase.at, 3) + " s";
    out += (row->phase.name == "t = " + at ? "" : row->phase.name + ", ") + "push at " + at + "\n";
    const auto line = [&](const std::string& label, const auto& cell) {
      out += "  " + padded(label, label_width);
      for (size_t i = 0; i < directions; ++i) out += push_cell(cell(row[i]), kCell);
      out += "\n";
    };
    line("direction, deg",
         [](const PushCase& c) { return text::fixed(c.direction * 180 / M_PI, 0); });
    line(open + ", N s", [](const PushCase& c) { return impulse_text(c.open_loop); });
    for (size_t k = 0; k < push.controllers.size(); ++k)
      line(name_of(push.controllers[k].type) + ", N s",
           [k](const PushCase& c) { return impulse_text(c.limits[k]); });
    line("B, N s", [](const PushCase& c) { return text::fixed(c.bound, 2); });
    line(open + ", x B", [](const PushCase& c) { return ratio_text(c.open_loop, c.bound); });
    for (size_t k = 0; k < push.controllers.size(); ++k)
      line(name_of(push.controllers[k].type) + ", x B",
           [k](const PushCase& c) { return ratio_text(c.limits[k], c.bound); });
    for (size_t k = 0; k < push.controllers.size(); ++k)
      line(name_of(push.controllers[k].type) + " J/m, m/s",
           [k](const PushCase& c) { return text::fixed(push_speed(c, c.limits[k].impulse), 3); });
    for (size_t k = 0; k < push.controllers.size(); ++k)
      line(name_of(push.controllers[k].type) + " J/mv",
           [k](const PushCase& c) { return text::fixed(push_froude(c, c.limits[k].impulse), 3); });
  }
  out += std::string(kPushBoundLegend) +
         ". x B = the largest push that the robot survived, as a multiple of B. + = the robot "
         "survived even the largest push that was tried\n"
         "J/m = speed that the push gives to the COG. J/mv (without a unit) = this speed divided "
         "by v = sqrt(g z), where z is the height of the COG above the ZMP\n";
  for (const std::string& line : push_summary_lines(cases, push, series)) out += line + "\n";
  return out;
}

Json result_json(const std::vector<PushCase>& cases, const PushOptions& push, double wall) {
  double worst = 0, sum = 0;
  int count = 0, runs = 0;
  for (const PushCase& c : cases) {
    runs += c.open_loop.runs;
    for (const PushLimit& limit : c.limits) runs += limit.runs;
    if (c.limits.empty() || c.bound <= 0) continue;
    const double ratio = c.limits.front().impulse / c.bound;
    worst = count == 0 ? ratio : std::min(worst, ratio);
    sum += ratio;
    ++count;
  }
  Json thresholds = thresholds_json(cases, push.controllers);
  size_t next = 0;
  for (const PushCase& c : cases)
    for (const PushLimit& limit : c.limits) {
      Json& threshold = thresholds[next++];
      threshold["J_per_m_m_per_s"] = push_speed(c, limit.impulse);
      threshold["J_per_m_sqrt_gz"] = push_froude(c, limit.impulse);
    }
  return {{"thresholds", thresholds},
          {"worst_ratio", worst},
          {"mean_ratio", count ? sum / count : 0.0},
          {"summary", summaries_json(cases, push)},
          {"runs", runs},
          {"wall_s", wall}};
}

void find_limits(Context& context, const PushCommand& options) {
  plant_of(options.plant);  // a missing plant is refused before anything is computed
  if (!options.map.empty()) {
    const std::string type = std::filesystem::path(options.map).extension().string();
    if (type != ".svg" && type != ".png")
      fail(ErrorCode::usage, "--map " + options.map + ": the name must end in .svg or .png");
    refuse_overwriting(context, options.map);
  }
  if (!options.out.empty()) require_file_target(options.out);
  const Task input = load_pattern(context, options.pattern, options.input);
  note_missing_noise(input.robot, options.push.simulate.sensor_noise);
  const PushOptions push = push_options(context, input, options);
  const Json study = study_json(input, push);
  KnownCases known(push.phases.size() * static_cast<size_t>(push.directions));
  if (!options.out.empty() && !context.force)
    known = read_results(options.out, study, known.size());
  const KnownCases before = known;
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<PushCase> cases = push_limits(
      input.robot, input.series, push, before,
      [&](size_t i, const PushCase& found) {
        known[i] = found;
        if (!options.out.empty()) write_file(options.out, results_text(study, known));
      },
      context.progress());
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  context.print(table(cases, push, input.series));
  if (!options.map.empty()) {
    write_push_map(
        push_map(push_map_title(shown_name(input.pattern), input.robot.name(), input.profile, push),
                 cases, push, input.series),
        options.map);
    context.print("  drawn in " + options.map + "\n");
  }
  if (!options.out.empty()) context.print("  written to " + options.out + "\n");
  context.print_json(result_json(cases, push, wall).dump(2));
}

}  // namespace

void add_push(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "push", "find the largest push that the robot survives, by gait phase and direction");
  command->footer(
      "Examples:\n"
      "  ayumi push patterns/hoap1_walk.json -o out/push.json --map out/push.svg\n"
      "  ayumi push walk.json --profile hoap1-strong --controller dtad --controller dtad-literal\n"
      "  ayumi push walk.json --times 3.1 --times 3.4 --directions 4 --json\n"
      "Run the command again with the same -o to continue a study. The scenario of the pattern is "
      "ignored, including lasting disturbances (payload, friction, latency, ...).");
  auto options = std::make_shared<PushCommand>();
  PushOptions& push = options->push;
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command
      ->add_option(
          "-o,--out", options->out,
          "File for the results, as JSON. Run the command again with the same file to continue.")
      ->type_name("F");
  command
      ->add_option("--map", options->map,
                   "Draw a map of the largest pushes by direction, seen from above (.svg or .png).")
      ->type_name("F");
  add_pattern_options(*command, options->input);
  command
      ->add_option("--controller", options->controllers,
                   "Controller to compare with open loop. May be repeated (default: the controller "
                   "of the pattern).")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--gain", options->gains, "Set a gain of the controller.")
      ->type_name("GAIN=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--directions", push.directions,
                   "Number of directions, evenly spread; the first is forward.")
      ->check(whole_number_within(PushOptions::kDirections).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_push_times(*command, options->times);
  command
      ->add_option("--step", push.step,
                   "Resolution of the search as a multiple of the capture bound.")
      ->check(number_within(PushOptions::kStep).description(""))
      ->type_name("X")
      ->capture_default_str();
  command->add_option("--cap", push.cap, "Largest push tried, as a multiple of the capture bound.")
      ->check(number_within(PushOptions::kCap).description(""))
      ->type_name("X")
      ->capture_default_str();
  command
      ->add_option("--replicas", push.replicas,
                   "Number of small variations of every push. The robot must survive all of them.")
      ->check(whole_number_within(PushOptions::kReplicas).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--duration", push.duration, "Duration of a push [s].")
      ->check(number_within(PushOptions::kDuration).description(""))
      ->type_name("T")
      ->capture_default_str();
  add_noise_flag(*command, push.simulate.sensor_noise);
  command
      ->add_option("--substeps", push.simulate.substeps,
                   "Number of integrator steps per servo period.")
      ->check(whole_number_within(SimulateOptions::kSubsteps).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_unstable_flag(*command, options->unstable);
  add_plant_option(*command, options->plant);
  command->callback([options, &context] { find_limits(context, *options); });
}

}  // namespace ayumi::app
