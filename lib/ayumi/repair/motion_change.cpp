#include "ayumi/repair/motion_change.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

namespace {

void raise(LargestChange& largest, double size, double t) {
  if (size > largest.size) largest = {size, t};
}

JointChange joint_change(const RobotModel& model, int dof, const CommandSeries& before,
                         const CommandSeries& after, size_t count) {
  JointChange change;
  change.joint = model.dofs()[dof].name;
  auto at = [&](size_t k) {
    return after.samples[k].state.theta[dof] - before.samples[k].state.theta[dof];
  };
  for (size_t k = 0; k < count; ++k) {
    if (std::abs(at(k)) <= std::abs(change.most)) continue;
    change.most = at(k);
    change.at = before.dt * static_cast<double>(k);
  }
  bool begun = false;
  for (size_t k = 0; k < count; ++k) {
    if (std::abs(at(k)) <= repair_policy::report::kChangeShare * std::abs(change.most)) continue;
    change.end = before.dt * static_cast<double>(k);
    if (!begun) change.begin = change.end;
    begun = true;
  }
  return change;
}

}  // namespace

MotionChange motion_change(const RobotModel& model, const CommandSeries& before,
                           const CommandSeries& after) {
  if (std::abs(before.dt - after.dt) > 1e-12)
    fail(ErrorCode::usage, "motions sampled every " + text::exact(before.dt) + " s and every " +
                               text::exact(after.dt) + " s cannot be compared");
  MotionChange change;
  const size_t count = std::min(before.samples.size(), after.samples.size());
  if (count == 0) return change;
  change.compared = before.dt * static_cast<double>(count - 1);
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const JointChange joint = joint_change(model, dof, before, after, count);
    if (std::abs(joint.most) > repair_policy::report::kMoved) change.joints.push_back(joint);
    raise(change.joint, std::abs(joint.most), joint.at);
  }
  std::stable_sort(change.joints.begin(), change.joints.end(), [](const auto& a, const auto& b) {
    return std::abs(a.most) > std::abs(b.most);
  });
  RobotData data_a(model), data_b(model);
  for (size_t k = 0; k < count; ++k) {
    const CommandSample &a = before.samples[k], &b = after.samples[k];
    const double t = before.dt * static_cast<double>(k);
    update_positions(model, a.state, data_a);
    update_positions(model, b.state, data_b);
    raise(change.cog, (data_b.cog - data_a.cog).norm(), t);
    raise(change.zmp, (b.zmp - a.zmp).norm(), t);
    raise(change.fz, std::abs(b.fz - a.fz), t);
    for (const Side side : {Side::left, Side::right})
      raise(change.foot,
            (sole_pose(model, data_b, side).translation() -
             sole_pose(model, data_a, side).translation())
                .norm(),
            t);
  }
  return change;
}

}  // namespace ayumi
