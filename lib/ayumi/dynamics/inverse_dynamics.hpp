#pragma once
// Rigid-body dynamics of the floating tree. Generalised velocity [v_WB; w_WB; dtheta], acceleration
// its time derivative (v_WB differentiated in the world: classical, not spatial), generalised force
// [force; moment about the base origin; joint torques], all world axes. Gravity is kGravity along
// -z. Rotor inertia and joint friction are not part of these functions.

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// Generalised force that gives `acceleration` (6+dof) in `state`: RNEA. The first six entries are
/// the wrench the surroundings must supply. Fills positions and velocities of `data`.
Eigen::VectorXd inverse_dynamics(const RobotModel& model, const RobotState& state,
                                 const Eigen::VectorXd& acceleration, RobotData& data);

/// The same into `force` where `data` already holds the velocities of `state`; allocates nothing
/// when `force` has its size.
void newton_euler(const RobotModel& model, const RobotState& state,
                  const Eigen::VectorXd& acceleration, RobotData& data, Eigen::VectorXd& force);

/// Coriolis, centrifugal and gravity forces: inverse_dynamics at zero acceleration.
Eigen::VectorXd bias_force(const RobotModel& model, const RobotState& state, RobotData& data);

/// (6+dof) square, symmetric: composite rigid bodies. Needs update_positions().
void mass_matrix(const RobotModel& model, RobotData& data, Eigen::MatrixXd& M);

/// Acceleration under a generalised force: M^-1 (force - bias).
Eigen::VectorXd forward_dynamics(const RobotModel& model, const RobotState& state,
                                 const Eigen::VectorXd& force, RobotData& data);

/// Linear momentum [N s] and angular momentum about the COG [N m s], world axes.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};
/// Needs update_velocities().
Momentum centroidal_momentum(const RobotModel& model, const RobotData& data);

}  // namespace ayumi
