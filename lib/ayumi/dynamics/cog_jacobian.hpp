#pragma once
// The Jacobian of the COG, (5)-(13) of the paper: with one foot at rest, the base at rest, or a
// floating base. All functions need update_positions() and give results in world axes. The rows of
// Jacobians are in m/s per rad/s (or per m/s for a prismatic joint).

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

}  // namespace ayumi
