#include "ayumi/repair/repair_pattern.hpp"

#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

RepairOptions preferred_options(const Pattern& pattern) {
  const RepairPreferences wishes = without_keyframes(pattern);
  RepairOptions options;
  options.locked_joints = wishes.joints;
  options.locked_feet = wishes.feet;
  options.locked_windows = wishes.windows;
  options.joint_weights = wishes.weights;
  options.trust = wishes.trust.value_or(options.trust);
  options.zmp_margin = wishes.margin;
  options.safety = wishes.safety.value_or(options.safety);
  return options;
}

RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress) {
  RepairResult result = repair(model, series, options, progress);
  if (result.status == RepairStatus::already_consistent || !pattern.correction) return result;
  Pattern plain = pattern;
  plain.correction.reset();
  return repair(model, sample(model, plain, {.dt = series.dt}, progress), options, progress);
}

}  // namespace ayumi
