#pragma once
// Rotations: cross matrices, exponential and logarithm, roll-pitch-yaw.

#include <Eigen/Geometry>

namespace ayumi {

/// The matrix [v x], so that skew(v) * u = v.cross(u).
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The rotation by |r| [rad] about r.
Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& r);

/// The rotation vector of q, with |r| <= pi [rad]. exp_rotation(log_rotation(q)) = +-q.
Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q);

/// The smallest rotation that takes the direction of `from` to that of `to`. The lengths of the
/// vectors have no effect, and neither vector may be zero. Between opposite directions it is one of
/// the many half turns.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// R = Rz(yaw) Ry(pitch) Rx(roll), where rpy = (roll, pitch, yaw) [rad].
Eigen::Matrix3d rpy_to_matrix(const Eigen::Vector3d& rpy);

/// The inverse of rpy_to_matrix(), with the pitch in [-pi/2, pi/2].
Eigen::Vector3d matrix_to_rpy(const Eigen::Matrix3d& rotation);

}  // namespace ayumi
