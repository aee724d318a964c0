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

RepairResult generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                      const RepairOptions& options, const Progress& progress) {
  RepairOptions how = options;
  how.generate.emplace();
  for (const Keyframe& key : pattern.keyframes) {
    how.generate->cog[0] |= key.cog_x.has_value();
    how.generate->cog[1] |= key.cog_y.has_value();
    how.generate->cog[2] |= key.cog_height.has_value();
  }
  if (pattern.table && !pattern.table->cog.empty()) how.generate->cog = {true, true, true};
  return repair(model, plan, how, progress);
}

}  // namespace ayumi
