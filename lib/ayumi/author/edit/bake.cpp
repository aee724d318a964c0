#include <algorithm>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

namespace {

// Keys that a table cannot replace: weights of joints, and planned poses of a swing foot.
std::vector<Keyframe> kept_keys(const Pattern& pattern) {
  std::vector<Keyframe> kept;
  for (const Keyframe& key : pattern.keyframes) {
    if (key.weights.empty() && !key.feet[0] && !key.feet[1]) continue;
    Keyframe rest;
    rest.t = key.t;
    rest.interpolation = key.interpolation;
    rest.feet = key.feet;
    rest.weights = key.weights;
    rest.place = key.place;
    rest.pointer = key.pointer;
    kept.push_back(std::move(rest));
  }
  return kept;
}

}  // namespace

Pattern baked(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
              const std::string& table) {
  refuse_viip_phases(pattern, "baked");
  Pattern result = pattern;
  result.repair = without_keyframes(pattern);
  result.keyframes = kept_keys(pattern);
  result.correction.reset();
  result.parameters.clear();
  // The last tick may be slightly after the end of the motion.
  const auto has_step = [](const Phase& phase) { return phase.swing && phase.swing->step; };
  if (std::any_of(result.phases.begin(), result.phases.end(), has_step))
    result.phases = FootPlan(model, pattern).phases();
  if (!result.phases.empty())
    result.phases.back().until = std::max(result.phases.back().until, series.duration());
  result.table.emplace();
  DenseTable& dense = *result.table;
  dense.file = table;
  dense.dt = series.dt;
  dense.joints = model.dof_names();
  const auto rows = static_cast<Eigen::Index>(series.samples.size());
  dense.theta.resize(rows, model.dof_count());
  for (Eigen::Index k = 0; k < rows; ++k) {
    const CommandSample& sample = series.samples[static_cast<size_t>(k)];
    dense.theta.row(k) = sample.state.theta.transpose();
    dense.base.push_back(sample.state.base);
    dense.cog.push_back(sample.cog);
    dense.zmp.push_back(sample.zmp);
    dense.fz.push_back(sample.fz);
  }
  return result;
}

}  // namespace ayumi
