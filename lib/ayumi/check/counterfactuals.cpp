#include "ayumi/check/counterfactuals.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

// Largest overlap that bodies at a wrong angle may have and still only touch because of that angle
// [m]; deeper overlaps are separate findings. Chosen: 3 % of the height of a small humanoid (0.5
// m). No measured case changes between half and twice the value (constants.md).
constexpr double kTouch = 0.015;

}  // namespace

bool touches_by_limits(const JudgedMotion& motion, const Violation& v) {
  if (-v.value > kTouch) return false;
  RobotState state = motion.series.samples[v.sample].state;
  for (int i = 0; i < motion.model.dof_count(); ++i)
    if (const Dof& dof = motion.model.dofs()[i]; dof.limited)
      state.theta[i] = std::clamp(state.theta[i], dof.lower, dof.upper);
  RobotData data(motion.model);
  update_positions(motion.model, state, data);
  return motion.collisions.clearance(motion.collisions.pairs()[v.item], data, kTouch) >= 0;
}

bool sets_distance(const JudgedMotion& motion, const Violation& v, int dof) {
  const auto beyond = [&](int body) {
    while (body > 0 && motion.model.bodies()[body].dof != dof)
      body = motion.model.bodies()[body].parent;
    return body > 0;
  };
  const CollisionModel::Pair& pair = motion.collisions.pairs()[v.item];
  return beyond(pair.a) != beyond(pair.b);
}

bool hangs_on(const JudgedMotion& motion, const Violation& v, int dof) {
  const CollisionModel::Pair& pair = motion.collisions.pairs()[v.item];
  const int trunk = motion.model.trunk_body();
  if (!motion.model.is_leg_joint(dof) && (pair.a == trunk || pair.b == trunk)) return false;
  return sets_distance(motion, v, dof);
}

bool holds_in_free_flight(JudgedMotion& motion, const Violation& v) {
  return std::abs(motion.dynamics.free_flight(v.sample).torque[v.item]) <= std::abs(v.limit);
}

bool moves_cog(const JudgedMotion& motion, const Violation& foot, const Violation& cog) {
  const Side side = foot_of(foot);
  const CommandSample& s = motion.series.samples[cog.sample];
  const ContactInterval& contact = motion.plan.at(side, cog.sample);
  if (!contact.contact) return true;
  const Eigen::Isometry3d& place = contact.sole;
  RobotData data(motion.model);
  update_positions(motion.model, s.state, data);
  const Eigen::Isometry3d sole = sole_pose(motion.model, data, side);
  const SoleError e = sole_error(motion.model.sole(side), sole, place);
  const double way = std::max({e.slip, e.penetration, e.gap});
  const double left = (place * (sole.inverse() * data.cog) - s.cog).norm();
  return cog.value <= way || left <= motion.tolerance(FindingKind::cog_residual);
}

bool is_asked_for(JudgedMotion& motion, const Violation& v) {
  if (v.kind != FindingKind::support_margin) return false;
  const Eigen::Vector3d zmp = motion.dynamics.at(v.sample).use.zmp_world;
  const Eigen::Vector3d& command = motion.series.samples[v.sample].zmp;
  const SupportPlane& plane = motion.dynamics.plane();
  const Eigen::Vector3d inside = plane.frame.inverse() * command;
  return (zmp - command).norm() <= motion.tolerance(FindingKind::zmp_residual) &&
         plane.polygon.margin(inside.head<2>()) < -kRounding;
}

bool uncounted_foot_stands(const JudgedMotion& motion, int k) {
  RobotData data(motion.model);
  update_positions(motion.model, motion.series.samples[k].state, data);
  for (const Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side), interval = motion.plan.index[s][k];
    if (motion.plan.at(side, k).contact) continue;
    for (const int next : {interval - 1, interval + 1}) {
      if (next < 0 || next >= static_cast<int>(motion.plan.intervals[s].size())) continue;
      const SoleError e = sole_error(motion.model.sole(side), sole_pose(motion.model, data, side),
                                     motion.plan.intervals[s][next].sole);
      if (e.gap <= motion.tolerance(FindingKind::foot_float) &&
          e.slip <= motion.tolerance(FindingKind::foot_slip))
        return true;
    }
  }
  return false;
}

}  // namespace ayumi
