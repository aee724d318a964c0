#pragma once
// Rows of the pose of a sole, for the limits of standing and of swinging feet.

#include "ayumi/limits/row.hpp"

namespace ayumi {

/// Deviation of a sole from its place: position [m] and rotation [rad], world axes.
Vector6d sole_deviation(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& planned);

/// Derivatives of sole_deviation(): rows of SoleRows::rate.
Eigen::MatrixXd deviation_rates(const Eigen::Isometry3d& sole, const Eigen::Isometry3d& planned,
                                const Eigen::MatrixXd& motion);

/// Curvature K of a rotation error  d . vee(E - E')/2,  E = R R_planned'.
Eigen::Matrix3d turn_curvature(const Eigen::Vector3d& d, const Eigen::Isometry3d& sole,
                               const Eigen::Isometry3d& planned);

/// Six rows: the deviation of a sole from a pose.
SoleRows deviation_rows(Side side, const Eigen::Isometry3d& planned);

/// Heights of the corners of a sole over the plane of a pose [m].
SoleRows height_rows(const RobotModel& model, Side side, const Eigen::Isometry3d& ground);

/// Height of a sole's origin over the plane of a pose [m].
double height_over(const Eigen::Isometry3d& place, const Eigen::Isometry3d& sole);

}  // namespace ayumi
