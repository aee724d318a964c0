#pragma once
// The figures of a simulated jump, read from the log alone.

#include <algorithm>
#include <cmath>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::test {

struct JumpMeasured {
  double lift_off = 0, touchdown = 0;  ///< times [s]
  double apex = 0;                     ///< height of the COG above ref z_G [m]
  double clearance = 0;                ///< largest clearance of the lowest corner of both soles [m]
  double stoop = 0;                    ///< depth of the COG below its height at touchdown [m]
  double momentum = 0;  ///< largest relative change in flight, apart from that by gravity
  double spin = 0;      ///< angular momentum about the COG in flight [N m s]
};

/// Lowest corner of both soles above the ground [m].
inline double sole_clearance(const RobotModel& model, const RobotData& data) {
  double lowest = 1e9;
  for (const Side side : {Side::left, Side::right})
    for (const Eigen::Vector2d& v : model.sole(side).polygon)
      lowest =
          std::min(lowest, (sole_pose(model, data, side) * Eigen::Vector3d(v.x(), v.y(), 0)).z());
  return lowest;
}

/// All flights of at least 40 ms; `ref` is ref z_G.
inline std::vector<JumpMeasured> jumps_of(const RobotModel& model, const SimulationLog& log,
                                          double ref) {
  std::vector<JumpMeasured> jumps;
  const auto& s = log.samples;
  RobotData data(model);
  const double weight = model.mass() * kGravity;
  for (size_t k = 1; k < s.size(); ++k) {
    if (s[k].fz > 0 || s[k - 1].fz <= 0) continue;
    size_t end = k;
    while (end < s.size() && s[end].fz <= 0.001 * weight) ++end;
    if (end - k < 40 || end >= s.size()) continue;
    JumpMeasured j;
    j.lift_off = static_cast<double>(k) * log.dt;
    j.touchdown = static_cast<double>(end) * log.dt;
    Momentum first;
    size_t from = 0;
    for (size_t i = k; i < end; ++i) {
      update_velocities(model, s[i].state, data);
      j.apex = std::max(j.apex, s[i].cog.z() - ref);
      j.clearance = std::max(j.clearance, sole_clearance(model, data));
      if (s[i].fz > 0) {
        from = 0;
        continue;
      }
      const Momentum now = centroidal_momentum(model, data);
      if (from == 0) {
        from = i;
        first = now;
        j.spin = now.angular.norm();
        continue;
      }
      const double fallen = weight * log.dt * static_cast<double>(i - from);
      const double scale = first.linear.norm();
      j.momentum = std::max(
          {j.momentum, (now.linear - first.linear + Eigen::Vector3d(0, 0, fallen)).norm() / scale,
           (now.angular - first.angular).norm() / scale});
    }
    double lowest = s[end].cog.z();
    for (size_t i = end; i < s.size() && s[i].cog.z() <= lowest + 1e-4; ++i)
      lowest = std::min(lowest, s[i].cog.z());
    j.stoop = s[end].cog.z() - lowest;
    jumps.push_back(j);
    k = end;
  }
  return jumps;
}

/// The time after which the COG stays within `near` of ref z_G and, horizontally, of its final
/// place [s].
inline double settled_at(const SimulationLog& log, double ref, double near) {
  const auto& s = log.samples;
  // The plan's frame relative to the world's is taken as a mean, because the measured values are
  // noisy.
  const size_t last = std::min<size_t>(200, s.size());
  Eigen::Vector2d rest = s.back().command_cog.head<2>();
  for (size_t i = s.size() - last; i < s.size(); ++i)
    rest += (s[i].cog - s[i].measured_cog).head<2>() / static_cast<double>(last);
  size_t k = s.size();
  while (k > 0 && std::abs(s[k - 1].cog.z() - ref) < near &&
         (s[k - 1].cog.head<2>() - rest).norm() < near)
    --k;
  return static_cast<double>(k) * log.dt;
}

/// The largest displacement of a sole over the ground from the first to the last sample, minus
/// `way` [m].
inline double feet_drift(const RobotModel& model, const SimulationLog& log,
                         const Eigen::Vector2d& way) {
  RobotData first(model), last(model);
  update_positions(model, log.samples.front().state, first);
  update_positions(model, log.samples.back().state, last);
  double drift = 0;
  for (const Side side : {Side::left, Side::right})
    drift = std::max(drift, ((sole_pose(model, last, side).translation() -
                              sole_pose(model, first, side).translation())
                                 .head<2>() -
                             way)
                                .norm());
  return drift;
}

}  // namespace ayumi::test
