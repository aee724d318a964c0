#include "ayumi/math/rotation.hpp"

#include <cmath>

#include "ayumi/math/elementary.hpp"
#include "ayumi/math/heading.hpp"

namespace ayumi {

Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  // Computes sin(a/2)/a by its series near zero, where the quotient loses digits.
  const double s = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : elementary::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = s * r;
  return Eigen::Quaterniond(elementary::cos(0.5 * angle), v.x(), v.y(), v.z());
}

Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double w = sign * q.w();
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  if (sine < 1e-8) return 2.0 * v;
  return 2.0 * elementary::atan2(sine, w) / sine * v;
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Matrix3d rpy_to_matrix(const Eigen::Vector3d& rpy) {
  using elementary::turn_quaternion;
  return (turn_quaternion(rpy.z(), Eigen::Vector3d::UnitZ()) *
          turn_quaternion(rpy.y(), Eigen::Vector3d::UnitY()) *
          turn_quaternion(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d matrix_to_rpy(const Eigen::Matrix3d& rotation) {
  const double pitch =
      elementary::atan2(-rotation(2, 0), elementary::hypot(rotation(0, 0), rotation(1, 0)));
  const double roll = elementary::atan2(rotation(2, 1), rotation(2, 2));
  return {roll, pitch, heading_of(rotation)};
}

}  // namespace ayumi
