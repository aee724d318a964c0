#pragma once
// The Jacobian of the COG for each kind of support, (5)-(13) of the paper: one foot on the ground,
// both feet, or none. All functions need update_positions() and give results in world axes. The
// rows of Jacobians are in m/s per rad/s (or per m/s for a prismatic joint).

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// (13), 3 x dof: COG velocity per joint rate while the sole of `support` is at rest. This is the
/// function that the controllers run (control/whole_body). It allocates nothing if J already has
/// its size.
void cog_jacobian(const RobotModel& model, RobotData& data, Side support, Eigen::MatrixXd& J);
Eigen::MatrixXd cog_jacobian(const RobotModel& model, RobotData& data, Side support);

/// (6)(7), 3 x dof: COG velocity per joint rate while the base is at rest. The function allocates
/// nothing when J has its size.
void held_base_cog_jacobian(const RobotModel& model, RobotData& data, Eigen::MatrixXd& J);

/// (5)-(7), 3 x (6+dof): COG velocity per generalised velocity of the floating base.
Eigen::MatrixXd cog_jacobian_floating(const RobotModel& model, RobotData& data);

/// (8)-(11), (6+dof) x dof: generalised velocity per joint rate while the sole of `support` is at
/// rest.
Eigen::MatrixXd anchored_velocity_map(const RobotModel& model, const RobotData& data, Side support);

/// (6+dof) x dof: generalised velocity per joint rate on both feet. The base moves so that the two
/// soles move as little as possible, where turns are multiplied by 0.2 m. If the joint rates allow
/// both soles to be at rest, they are at rest.
Eigen::MatrixXd both_feet_velocity_map(const RobotModel& model, const RobotData& data);

/// (13) on both feet, 3 x dof, with the base velocity of both_feet_velocity_map().
Eigen::MatrixXd both_feet_cog_jacobian(const RobotModel& model, RobotData& data);

/// (6+dof) x dof in flight: the base moves against the limbs so that linear and angular momentum
/// stay zero. The COG does not move with the joints then.
Eigen::MatrixXd flight_velocity_map(const RobotModel& model, RobotData& data);

}  // namespace ayumi
