#include "ayumi/repair/repair_pattern.hpp"

#include <algorithm>

#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/plan/sample_plan.hpp"
#include "ayumi/repair/infeasibility_report.hpp"

namespace ayumi {

namespace policy = repair_policy;

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

namespace {

// The start of a generated motion, and how wrong it is.
struct PlanStart {
  CommandSeries series;
  double violation = 0;
};

bool has_key(const Pattern& pattern, std::optional<double> Keyframe::*coordinate) {
  return (pattern.table && !pattern.table->cog.empty()) ||
         std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                     [&](const Keyframe& key) { return (key.*coordinate).has_value(); });
}

// Where no key gives the height of the COG, lower ones are tried, too: bent legs reach farther.
std::vector<Pattern> with_lower_cogs(const RobotModel& model, const Pattern& pattern) {
  std::vector<Pattern> all = {pattern};
  if (has_key(pattern, &Keyframe::cog_height)) return all;
  for (const double share : policy::generation::kHeights)
    all.emplace_back(pattern).cog_height = share * default_cog_height(model, pattern);
  return all;
}

}  // namespace

RepairResult generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                      const RepairOptions& options, const Progress& progress) {
  const auto violation_of = [&](const CommandSeries& series) {
    const ConsistencyReport check = check_consistency(model, series, options.check);
    return check.consistent ? 0 : total_violation(check);
  };
  PlanStart start = {plan, violation_of(plan)};
  const SampleOptions sampling = {.dt = plan.dt, .threads = options.check.threads};
  std::vector<PlannedCog> ways = {PlannedCog::keys};
  if (has_key(pattern, &Keyframe::cog_x) || has_key(pattern, &Keyframe::cog_y))
    ways.push_back(PlannedCog::zmp);
  for (const Pattern& tried : with_lower_cogs(model, pattern)) {
    for (const PlannedCog cog : ways) {
      if (start.violation == 0) break;
      CommandSeries series = sample_plan(model, tried, sampling, progress, cog);
      const double violation = violation_of(series);
      if (violation < start.violation) start = {std::move(series), violation};
    }
  }
  RepairResult result = repair(model, start.series, options, progress);
  if (result.status == RepairStatus::already_consistent) result.status = RepairStatus::repaired;
  return result;
}

}  // namespace ayumi
