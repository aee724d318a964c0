#pragma once
// The offset of a swinging sole from its landing place.

#include "ayumi/limits/row.hpp"

namespace ayumi {

/// The offset of a sole from its place without the height: two lengths along the ground, and the
/// rotations about three axes times half the sole's size [m].
Eigen::Matrix<double, 5, 1> landing_offset(const RobotModel& model, Side side,
                                           const Eigen::Isometry3d& actual,
                                           const Eigen::Isometry3d& place);

}  // namespace ayumi
