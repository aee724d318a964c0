// Generators: write a keyframed pattern that a person can then edit.

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern_file.hpp"
#include "ayumi/pattern/generate.hpp"
#include "ayumi/pattern/sample.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

struct NewOptions {
  std::string robot = "hoap1", out;
  WalkParameters walk;
  double turn_deg = 0;
  std::string first = "right";
  double duration = 3.0;
};

// The generated motion is sampled before it is written: a file that cannot be used is not made.
void write_new(const Context& context, const RobotModel& model, Pattern pattern,
               const NewOptions& options, const std::vector<std::string>& comments) {
  refuse_overwriting(context, options.out);
  pattern.robot = options.robot;
  pattern.name = std::filesystem::path(options.out).stem().string();
  pattern.file = options.out;
  const CommandSeries series = sample(model, pattern, {}, context.progress());
  write_pattern(options.out, pattern, comments);
  context.print(options.out + ": " + text::fixed(series.duration(), 2) + " s, " +
                std::to_string(pattern.phases.size()) + " phases, " +
                std::to_string(pattern.keyframes.size()) + " keyframes\n  COG " +
                series.origin.at("cog") + "\n");
  context.print_json(nlohmann::ordered_json{{"pattern", options.out},
                                            {"duration_s", series.duration()},
                                            {"phases", pattern.phases.size()},
                                            {"keyframes", pattern.keyframes.size()}}
                         .dump(2));
}

void add_common(CLI::App& command, NewOptions& options) {
  command.add_option("--robot", options.robot, "a bundled robot, a sidecar or a URDF")
      ->type_name("ROBOT")
      ->capture_default_str();
  command.add_option("-o,--out", options.out, "pattern file to write")->type_name("F")->required();
}

void new_walk(const Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.robot, robot_search(context));
  WalkParameters& w = options.walk;
  w.turn = options.turn_deg * std::numbers::pi / 180;
  w.first_swing = options.first == "left" ? Side::left : Side::right;
  write_new(context, model, walk_pattern(model, w), options,
            {"Walk of " + std::to_string(w.steps) + " steps: stride " + text::brief(w.stride) +
                 " m, period " + text::brief(w.period) + " s, double support " +
                 text::brief(100 * w.double_support) + " %, lift " + text::brief(w.lift) + " m",
             "The COG is left out: it is solved from the ZMP keys for the whole robot."});
}

void new_stand(const Context& context, const NewOptions& options) {
  const RobotModel model = load_robot(options.robot, robot_search(context));
  write_new(context, model, stand_pattern(model, options.duration), options,
            {"Standing on both feet in the home posture."});
}

}  // namespace

void add_new(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("new", "write a keyframed pattern to edit: walk, stand");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  ayumi new walk -o walk.json\n"
      "  ayumi new walk --steps 12 --stride 0.02 --turn 5 -o turn.json\n"
      "  ayumi new stand --duration 4 -o stand.json");
  auto shared = std::make_shared<NewOptions>();
  NewOptions& options = *shared;

  CLI::App* walk = command->add_subcommand("walk", "steps that start and end at rest");
  walk->footer("Examples:\n  ayumi new walk --steps 10 --stride 0.025 --period 0.6 -o walk.json");
  add_common(*walk, options);
  WalkParameters& w = options.walk;
  walk->add_option("--steps", w.steps, "steps that move")->capture_default_str()->type_name("N");
  walk->add_option("--stride", w.stride, "between successive footholds, back is negative")
      ->capture_default_str()
      ->type_name("M");
  walk->add_option("--period", w.period, "of one step")->capture_default_str()->type_name("S");
  walk->add_option("--double-support", w.double_support, "share of the period")
      ->capture_default_str()
      ->type_name("SHARE");
  walk->add_option("--lift", w.lift, "of the swing sole")->capture_default_str()->type_name("M");
  walk->add_option("--cog-height", w.cog_height, "0: of the home posture")
      ->capture_default_str()
      ->type_name("M");
  walk->add_option("--turn", options.turn_deg, "per step, to the left")
      ->capture_default_str()
      ->type_name("DEG");
  walk->add_option("--side", w.side, "sideways per pair of steps, to the left")
      ->capture_default_str()
      ->type_name("M");
  walk->add_option("--first", options.first, "foot that swings first")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  walk->callback([shared, &context] { new_walk(context, *shared); });

  CLI::App* stand = command->add_subcommand("stand", "both feet on the ground");
  add_common(*stand, options);
  stand->add_option("--duration", options.duration, "of the pattern")
      ->capture_default_str()
      ->type_name("S");
  stand->callback([shared, &context] { new_stand(context, *shared); });
}

}  // namespace ayumi::app
