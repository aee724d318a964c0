#pragma once
// Moves a plan. Only this file moves a command over the ground. The pattern is moved when steps
// that VIIP placed end elsewhere (control/command_plan) and when footholds respond to a push
// (control/foothold_shift).

#include <array>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Offsets of a plan in world axes. The mass-concentrated model is linear, so COG and ZMP of a
/// moved plan obey (14)(15) if their offsets do: zmp = cog - ddcog / omega^2.
struct PlanShift {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< offset of the base position [m]
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();    ///< offset of the COG [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< its rate [m/s]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< its acceleration [m/s^2]
  Eigen::Vector2d zmp = Eigen::Vector2d::Zero();    ///< offset of the ZMP [m]
  /// Offsets of each foot: its position [m], and its attitude as a rotation vector in sole axes
  /// [rad].
  std::array<Eigen::Vector3d, 2> foot = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> foot_turn = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double time_scale = 1;  ///< rate of the plan's clock; the rates of the posture grow with it
};

/// Adds the offsets to `plan`.
void shift_plan(const PlanShift& shift, CommandSample& plan);

/// Moves the whole of `plan` by the rigid motion `turn` of the ground.
void turn_plan(const Eigen::Isometry3d& turn, CommandSample& plan);

/// Makes `plan` stop on the ground: the posture is at rest, the ZMP is under the COG, and f_z is
/// the weight.
void rest_plan(CommandSample& plan);

/// The level pose in the middle between two soles, with the mean of their headings.
Eigen::Isometry3d pose_between(const std::array<Eigen::Isometry3d, 2>& feet);

}  // namespace ayumi
