#include "new_pattern.hpp"

#include <nlohmann/json.hpp>

#include "ayumi/base/text.hpp"
#include "ayumi/check/actuator_need.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi::app {

namespace {

// The first profile whose actuators are enough where the robot's first one is not; what else the
// check finds is told, and false.
bool choose_profile(const Context& context, const RobotModel& model, Pattern& pattern,
                    const CommandSeries& series) {
  CheckOptions options;
  options.profile = pattern.profile;
  options.friction = pattern.world.friction;
  options.tolerances = pattern.tolerances;
  ConsistencyReport report = check_consistency(model, series, options);
  const ActuatorNeed need = actuator_need(model, series, options, report);
  if (pattern.profile.empty() && !need.sufficient.empty()) {
    options.profile = pattern.profile = need.sufficient.front();
    report = check_consistency(model, series, options);
    context.print("profile " + pattern.profile + " is written: " + need.text + "\n");
  } else if (!need.text.empty()) {
    context.print(need.text + "\n");
  }
  if (report.consistent) return true;
  const Finding& first = report.findings.front();
  context.print(std::string("`ayumi check` finds it inconsistent: ") + name_of(first.kind) + " " +
                first.where + " at " + text::fixed(first.at, 3) + " s: " + first.hint + "\n");
  return false;
}

}  // namespace

bool write_new_pattern(const Context& context, const RobotModel& model, Pattern pattern,
                       const std::string& robot, const std::string& out,
                       const std::vector<std::string>& comments) {
  refuse_overwriting(context, out);
  pattern.robot = robot_as_written(robot);
  pattern.name = std::filesystem::path(out).stem().string();
  pattern.file = out;
  const CommandSeries series = sample_at_servo_period(model, pattern, context.progress());
  const bool consistent =
      !series.viip.empty() || !model.has_soles() || choose_profile(context, model, pattern, series);
  pattern.file = "new";  // relative names hold from the working folder
  write_pattern(out, pattern, comments);
  context.print(out + ": " + text::fixed(series.duration(), 2) + " s, " +
                std::to_string(pattern.phases.size()) + " phases, " +
                std::to_string(pattern.keyframes.size()) + " keyframes\n  COG " +
                series.origin.at("cog") + "\n");
  context.print_json(nlohmann::ordered_json{{"pattern", out},
                                            {"duration_s", series.duration()},
                                            {"phases", pattern.phases.size()},
                                            {"keyframes", pattern.keyframes.size()}}
                         .dump(2));
  return consistent;
}

}  // namespace ayumi::app
