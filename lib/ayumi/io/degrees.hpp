#pragma once
// One degree, for the files that hold angles in degrees.

#include <Eigen/Core>

namespace ayumi {

inline constexpr double kRadiansPerDegree = EIGEN_PI / 180;  // Definition

}  // namespace ayumi
