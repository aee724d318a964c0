#pragma once
// The yaw of a body about the vertical.

#include <Eigen/Core>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

/// The third angle of matrix_to_rpy() alone [rad].
inline double heading_of(const Eigen::Matrix3d& rotation) {
  return elementary::atan2(rotation(1, 0), rotation(0, 0));
}

}  // namespace ayumi
