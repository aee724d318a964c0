#pragma once
// The offset of a swinging sole from its landing place.

#include "ayumi/limits/row.hpp"

namespace ayumi {

/// Offset of a sole from its place without the height: along the ground and, times half the sole's
/// size, around three axes [m].
Eigen::Matrix<double, 5, 1> landing_offset(const RobotModel& model, Side side,
                                           const Eigen::Isometry3d& actual,
                                           const Eigen::Isometry3d& place);

}  // namespace ayumi
