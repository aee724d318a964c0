#include "ayumi/task/run_stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/ground_world.hpp"
#include "ayumi/sim/fall_monitor.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using Feet = std::array<bool, 2>;

// For each sample, the first sample of the next planned contacts, or -1.
std::vector<int> next_planned(const SimulationLog& log) {
  std::vector<int> next(log.samples.size(), -1);
  for (int k = static_cast<int>(log.samples.size()) - 2; k >= 0; --k) {
    const auto i = static_cast<size_t>(k);
    next[i] =
        log.samples[i].planned_contact != log.samples[i + 1].planned_contact ? k + 1 : next[i + 1];
  }
  return next;
}

void add_corners(const RobotModel& model, const RobotData& data, const Feet& feet,
                 std::vector<Vector2d>& corners, double& height) {
  for (const Side side : {Side::left, Side::right}) {
    if (!feet[static_cast<size_t>(side)]) continue;
    const Sole& sole = model.sole(side);
    const Eigen::Isometry3d frame = data.pose(sole.body) * sole.frame;
    for (const Vector2d& corner : sole.polygon)
      corners.emplace_back((frame * Vector3d(corner.x(), corner.y(), 0)).head<2>());
    height = std::min(height, (frame * Vector3d(sole.center.x(), sole.center.y(), 0)).z());
  }
}

}  // namespace

StabilitySeries run_stability(const RobotModel& model, const ActuatorLimits& actuators,
                              const SimulationLog& log, double dt) {
  const int count = static_cast<int>(log.samples.size());
  const int stretch = std::max(1, static_cast<int>(std::lround(dt / log.dt)));
  StabilitySeries out =
      empty_stability(static_cast<size_t>((count + stretch - 1) / stretch), stretch * log.dt);
  const std::vector<int> next = next_planned(log);
  const double least_load = kTouchLoad * model.mass() * kGravity;
  RobotData now(model), later(model);
  int later_at = -1;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<size_t>(k / stretch);
    const SimulationSample& s = log.samples[static_cast<size_t>(k)];
    keep_worst(out.speed[i], out.speed_dof[i], s.state.dtheta, actuators.speed);
    keep_worst(out.torque[i], out.torque_dof[i], s.torque, actuators.peak_torque);
    const Feet carries = {s.foot_force[0].z() > least_load, s.foot_force[1].z() > least_load};
    if (!carries[0] && !carries[1]) continue;
    keep_least(out.normal_force[i], s.fz);
    const Vector3d up = floor_pose(log.world, {}, k * log.dt).linear().col(2);
    const Vector3d force = s.foot_force[0] + s.foot_force[1];
    const double normal = force.dot(up);
    if (normal > 0)
      keep_largest(out.friction[i], (force - normal * up).norm() / (log.world.friction * normal));
    update_positions(model, s.state, now);
    std::vector<Vector2d> corners;
    double height = std::numeric_limits<double>::infinity();
    add_corners(model, now, carries, corners, height);
    keep_least(out.zmp_margin[i], ConvexPolygon(corners).margin(s.zmp.head<2>()));
    if (s.cog.z() <= height) continue;  // the robot has fallen
    if (const int at = next[static_cast<size_t>(k)]; at >= 0) {
      const SimulationSample& then = log.samples[static_cast<size_t>(at)];
      if (at != later_at) update_positions(model, then.state, later);
      later_at = at;
      const Feet lands = {then.planned_contact[0] && !carries[0],
                          then.planned_contact[1] && !carries[1]};
      double ignored = height;
      add_corners(model, later, lands, corners, ignored);
    }
    const double omega = std::sqrt(kGravity / (s.cog.z() - height));
    keep_least(out.dcm_margin[i],
               ConvexPolygon(corners).margin((s.cog + s.dcog / omega).head<2>()));
  }
  return out;
}

}  // namespace ayumi
