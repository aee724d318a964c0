#pragma once
// Positions, velocities and the Jacobians of links, (1)-(4) of the paper. The Jacobian of the COG
// is in dynamics/cog_jacobian.hpp.

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// Fills the position part of `data` from the base pose and theta.
void update_positions(const RobotModel& model, const RobotState& state, RobotData& data);

/// Fills the positions and then, by (1)(2) from the root outwards, the velocity part.
void update_velocities(const RobotModel& model, const RobotState& state, RobotData& data);

/// Fills the velocity part alone. Needs update_positions().
void carry_velocities(const RobotModel& model, const RobotState& state, RobotData& data);

/// Changes what depends on the base pose in `data`, when only the base pose of the state has
/// changed. Needs update_positions().
void move_base(const BasePose& base, RobotData& data);

/// The pose of a link or of a sole frame in the world. Needs update_positions().
Eigen::Isometry3d link_pose(const RobotModel& model, const RobotData& data, int link);
Eigen::Isometry3d sole_pose(const RobotModel& model, const RobotData& data, Side side);

/// The velocity of a world point fixed to a body. Needs update_velocities().
Eigen::Vector3d point_velocity(const RobotData& data, int body, const Eigen::Vector3d& point);

/// (3)(4), 6 x (6+dof): the linear velocity of the world point `point` fixed to `body` (rows 0-2)
/// and the angular velocity of the body (rows 3-5) per generalised velocity, in world axes. Needs
/// update_positions().
Eigen::MatrixXd body_jacobian(const RobotModel& model, const RobotData& data, int body,
                              const Eigen::Vector3d& point);

/// (8)(9) for positions: moves the base of `state` so that the sole of `support` has the pose
/// `sole` in the world, and updates the positions in `data`.
void anchor_base(const RobotModel& model, Side support, const Eigen::Isometry3d& sole,
                 RobotState& state, RobotData& data);

}  // namespace ayumi
