#pragma once
// Sine, exponential function and their relatives with the same bits on every machine. The functions
// of the C library differ in the last bit between versions and between processors (with and without
// fused multiply-add), and a simulation of a walk amplifies this to a visible difference. Here,
// only operations are used for which IEEE 754 defines the rounding exactly: + - * / and the square
// root. Errors are below 1 unit in the last place for sin, cos (to 1e9 rad), exp, log, and atan,
// and below 2 for the others, except power(). The rooms that compute use these functions instead of
// those of <cmath>; architecture_tests looks for functions of <cmath>.

#include <Eigen/Geometry>

namespace ayumi::elementary {

double sin(double x);
double cos(double x);
double tan(double x);
double exp(double x);
double log(double x);  ///< -infinity at 0, and not a number below 0
double log10(double x);
double log1p(double x);  ///< log(1 + x), accurate near 0
double atan2(double y, double x);
double asin(double x);
double acos(double x);
double hypot(double x, double y);  ///< no intermediate result can overflow
/// x^y for x >= 0; the result is not a number for x below 0.
double power(double x, double y);

/// x^N by multiplication.
template <int N>
double power(double x) {
  static_assert(N >= 0);
  double result = 1;
  for (int i = 0; i < N; ++i) result *= x;
  return result;
}

/// The matrix of the rotation in the plane by `angle` [rad], as by Eigen::Rotation2Dd.
Eigen::Matrix2d turn_in_plane(double angle);
/// The matrix of the rotation by `angle` [rad] about the unit vector `axis`, as by
/// Eigen::AngleAxisd.
Eigen::Matrix3d turn_matrix(double angle, const Eigen::Vector3d& axis);
Eigen::Quaterniond turn_quaternion(double angle, const Eigen::Vector3d& axis);
/// The rotation that is between a and b on the shortest arc, at the fraction `share` of the angle,
/// as by Eigen's slerp().
Eigen::Quaterniond between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double share);
/// The angle between two attitudes [rad], as by Eigen's angularDistance().
double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace ayumi::elementary
