#pragma once
// Generalised velocity and COG velocity per joint rate for supports other than one sole, which is
// in dynamics/kinematics.hpp. Both need update_positions().

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// (6+dof) x dof on both feet: the base goes so that the two soles move least, turns weighted by
/// 0.2 m; for rates that keep both where they are, not at all.
Eigen::MatrixXd both_feet_velocity_map(const RobotModel& model, const RobotData& data);

/// (6+dof) x dof in flight: the base turns and shifts against the limbs so that the robot's
/// momentum stays zero.
Eigen::MatrixXd flight_velocity_map(const RobotModel& model, RobotData& data);

/// 3 x dof, (13) for both feet with the base as above. (In flight the COG does not move with the
/// joints at all.)
Eigen::MatrixXd both_feet_cog_jacobian(const RobotModel& model, RobotData& data);

/// 3 x dof, (13), the same as cog_jacobian() without its products of matrices: about the base
/// origin -J_Fb^-1 J_Fth is minus the joint's screw on the way to the supporting sole and zero
/// elsewhere. Allocates nothing when J has its size.
void anchored_cog_jacobian(const RobotModel& model, RobotData& data, Side support,
                           Eigen::MatrixXd& J);

/// 3 x dof, the same with the base held: the joint columns of cog_jacobian_floating().
void held_base_cog_jacobian(const RobotModel& model, RobotData& data, Eigen::MatrixXd& J);

}  // namespace ayumi
