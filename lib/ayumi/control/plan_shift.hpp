#pragma once
// A moved plan. Only this file moves a command over the ground. The pattern is moved when steps
// that VIIP placed end elsewhere (control/command_plan) and when footholds answer a push
// (control/foothold_shift).

#include <array>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Offsets of a plan in world axes. The mass-concentrated model is linear, so COG and ZMP of a
/// moved plan obey (14)(15) when their offsets do: zmp = cog - ddcog / omega^2.
struct PlanShift {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< of the base position [m]
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector2d zmp = Eigen::Vector2d::Zero();    ///< [m]
  /// Of each foot: its position [m] and its attitude, as a rotation vector in sole axes [rad].
  std::array<Eigen::Vector3d, 2> foot = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> foot_turn = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double time_scale = 1;  ///< of the plan's clock: rates of the posture grow with it
};

/// Adds the offsets to `plan`.
void shift_plan(const PlanShift& shift, CommandSample& plan);

/// Carries the whole of `plan` by the rigid motion `turn` of the ground.
void turn_plan(const Eigen::Isometry3d& turn, CommandSample& plan);

/// Stops a `plan` on the ground: its posture at rest, ZMP under the COG, f_z the weight.
void rest_plan(CommandSample& plan);

/// Level pose in the middle between two soles: position, and the mean of their headings.
Eigen::Isometry3d pose_between(const std::array<Eigen::Isometry3d, 2>& feet);

}  // namespace ayumi
