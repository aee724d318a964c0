#include "ayumi/check/what_if.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

constexpr double kTouch = 0.015;  // deeper overlaps are facts of their own [m]

}  // namespace

bool touches_by_limits(const CheckPass& pass, const Violation& v) {
  if (-v.value > kTouch) return false;
  RobotState state = pass.series.samples[v.sample].state;
  for (int i = 0; i < pass.model.dof_count(); ++i)
    if (const Dof& dof = pass.model.dofs()[i]; dof.limited)
      state.theta[i] = std::clamp(state.theta[i], dof.lower, dof.upper);
  RobotData data(pass.model);
  update_positions(pass.model, state, data);
  return pass.collisions.clearance(pass.collisions.pairs()[v.item], data, kTouch) >= 0;
}

bool in_leg(const RobotModel& model, Side side, int dof) {
  const std::vector<int>& leg = model.leg(side);
  return std::find(leg.begin(), leg.end(), dof) != leg.end();
}

bool sets_distance(const CheckPass& pass, const Violation& v, int dof) {
  const auto beyond = [&](int body) {
    while (body > 0 && pass.model.bodies()[body].dof != dof)
      body = pass.model.bodies()[body].parent;
    return body > 0;
  };
  const CollisionModel::Pair& pair = pass.collisions.pairs()[v.item];
  return beyond(pair.a) != beyond(pair.b);
}

bool hangs_on(const CheckPass& pass, const Violation& v, int dof) {
  const CollisionModel::Pair& pair = pass.collisions.pairs()[v.item];
  const int trunk = pass.model.trunk_body();
  const bool leg = in_leg(pass.model, Side::left, dof) || in_leg(pass.model, Side::right, dof);
  if (!leg && (pair.a == trunk || pair.b == trunk)) return false;
  return sets_distance(pass, v, dof);
}

bool holds_in_free_flight(CheckPass& pass, const Violation& v) {
  return std::abs(pass.dynamics.free_flight(v.sample).torque[v.item]) <= std::abs(v.limit);
}

bool moves_cog(const CheckPass& pass, const Violation& foot, const Violation& cog) {
  const Side side = foot_of(foot);
  const CommandSample& s = pass.series.samples[cog.sample];
  const ContactInterval& contact = pass.plan.at(side, cog.sample);
  if (!contact.contact) return true;
  const Eigen::Isometry3d& place = contact.sole;
  RobotData data(pass.model);
  update_positions(pass.model, s.state, data);
  const Eigen::Isometry3d sole = sole_pose(pass.model, data, side);
  const SoleError e = sole_error(pass.model.sole(side), sole, place);
  const double way = std::max({e.slip, e.penetration, e.gap});
  const double left = (place * (sole.inverse() * data.cog) - s.cog).norm();
  return cog.value <= way || left <= pass.tolerance(FindingKind::cog_residual);
}

bool is_asked_for(CheckPass& pass, const Violation& v) {
  if (v.kind != FindingKind::support_margin) return false;
  const Eigen::Vector3d zmp = pass.dynamics.at(v.sample).use.zmp_world;
  const Eigen::Vector3d& command = pass.series.samples[v.sample].zmp;
  const SupportPlane& plane = pass.dynamics.plane();
  const Eigen::Vector3d inside = plane.frame.inverse() * command;
  return (zmp - command).norm() <= pass.tolerance(FindingKind::zmp_residual) &&
         plane.polygon.margin(inside.head<2>()) < -kRounding;
}

bool uncounted_foot_stands(const CheckPass& pass, int k) {
  RobotData data(pass.model);
  update_positions(pass.model, pass.series.samples[k].state, data);
  for (const Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side), interval = pass.plan.index[s][k];
    if (pass.plan.at(side, k).contact) continue;
    for (const int next : {interval - 1, interval + 1}) {
      if (next < 0 || next >= static_cast<int>(pass.plan.intervals[s].size())) continue;
      const SoleError e = sole_error(pass.model.sole(side), sole_pose(pass.model, data, side),
                                     pass.plan.intervals[s][next].sole);
      if (e.gap <= pass.tolerance(FindingKind::foot_float) &&
          e.slip <= pass.tolerance(FindingKind::foot_slip))
        return true;
    }
  }
  return false;
}

}  // namespace ayumi
