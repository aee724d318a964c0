#pragma once
// Rows of the pose of a sole, for the limits of standing and of swinging feet.

#include "ayumi/limits/row.hpp"

namespace ayumi {

/// The deviation of a sole from its place: position [m] and rotation [rad] in world axes.
Vector6d sole_deviation(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& planned);

/// The derivatives of sole_deviation(), for SoleRows::rate.
Eigen::MatrixXd deviation_rates(const Eigen::Isometry3d& sole, const Eigen::Isometry3d& planned,
                                const Eigen::MatrixXd& motion);

/// The curvature K of a rotation error d . vee(E - E')/2, E = R R_planned'.
Eigen::Matrix3d turn_curvature(const Eigen::Vector3d& d, const Eigen::Isometry3d& sole,
                               const Eigen::Isometry3d& planned);

/// Six rows with the deviation of a sole from a pose.
SoleRows deviation_rows(Side side, const Eigen::Isometry3d& planned);

/// Heights of the corners of a sole over the plane of a pose [m].
SoleRows height_rows(const RobotModel& model, Side side, const Eigen::Isometry3d& ground);

/// The same for some points of the sole, in its frame [m].
SoleRows height_rows(Side side, std::vector<Eigen::Vector2d> points,
                     const Eigen::Isometry3d& ground);

/// Height of a sole's origin over the plane of a pose [m].
double height_over(const Eigen::Isometry3d& place, const Eigen::Isometry3d& sole);

}  // namespace ayumi
