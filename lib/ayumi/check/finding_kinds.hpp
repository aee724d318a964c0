#pragma once
// The kinds of findings as numbers, for the inner loop of the check. Their names, units and default
// tolerances are the table finding_kinds() in consistency.hpp, in the same order.

#include <array>

#include "ayumi/check/consistency.hpp"

namespace ayumi {

enum class Kind {
  cog_residual,
  zmp_residual,
  fz_residual,
  point_mass_gap,
  support_margin,
  friction,
  unilateral,
  yaw_moment,
  ballistic,
  angular_momentum,
  foot_slip,
  foot_penetration,
  foot_float,
  joint_position,
  joint_speed,
  joint_acceleration,
  joint_torque,
  continuous_torque,
  servo_step,
  self_collision,
  landing_speed,
};
inline constexpr int kKindCount = 21;

/// Whether it is one of the posture itself, the same at whatever pace; a speed, a torque or a ZMP
/// can be mended at an instant though the posture there stays.
bool is_of_posture(const Finding& finding);

/// Tolerances by Kind: the defaults with the overrides. Throws Error(usage) for an unknown name or
/// a tolerance that is not a finite number.
std::array<double, kKindCount> tolerances(const CheckOptions& options);

/// The same for a motion of one robot: what a moment in flight turns goes with weight times height,
/// so that its default limit is at least 0.65 % of that. A limit that was set stays as it is.
std::array<double, kKindCount> tolerances(const CheckOptions& options, const RobotModel& model,
                                          const CommandSeries& series);

}  // namespace ayumi
