#pragma once
// Rigid-body dynamics of the floating tree. The generalised velocity is [v_WB; w_WB; dtheta]. The
// acceleration is its time derivative (v_WB is differentiated in the world, which gives the
// classical acceleration, not the spatial one). The generalised force is [force; moment about the
// base origin; joint torques]. All are in world axes. Gravity is kGravity along -z. Rotor inertia
// and joint friction are not part of these functions.

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// The generalised force that gives `acceleration` (6+dof) in `state`, by recursive Newton-Euler.
/// The first six entries are the wrench that the surroundings must supply. Fills positions and
/// velocities of `data`.
Eigen::VectorXd inverse_dynamics(const RobotModel& model, const RobotState& state,
                                 const Eigen::VectorXd& acceleration, RobotData& data);

/// Writes the same into `force` if `data` already holds the velocities of `state`. It allocates
/// nothing if `force` has its size.
void newton_euler(const RobotModel& model, const RobotState& state,
                  const Eigen::VectorXd& acceleration, RobotData& data, Eigen::VectorXd& force);

/// Coriolis, centrifugal and gravity forces: the result of inverse_dynamics() at zero acceleration.
Eigen::VectorXd bias_force(const RobotModel& model, const RobotState& state, RobotData& data);

/// The mass matrix, (6+dof) square and symmetric, by composite rigid bodies. Needs
/// update_positions().
void mass_matrix(const RobotModel& model, RobotData& data, Eigen::MatrixXd& M);

/// The acceleration under a generalised force: M^-1 (force - bias).
Eigen::VectorXd forward_dynamics(const RobotModel& model, const RobotState& state,
                                 const Eigen::VectorXd& force, RobotData& data);

/// Linear momentum [N s] and angular momentum about the COG [N m s], world axes.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};
/// The momentum of the whole robot about its COG. Needs update_velocities().
Momentum centroidal_momentum(const RobotModel& model, const RobotData& data);

}  // namespace ayumi
