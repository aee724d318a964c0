#pragma once
// Distance and depth of two convex sets: Gilbert-Johnson-Keerthi for how far apart, an expanding
// polytope for how deep. A set is a box, a segment, a point, an upright cylinder or the convex hull
// of points.

#include <Eigen/Geometry>
#include <vector>

namespace ayumi {

/// The set of points (x, y, z) + r (cos, sin, 0), |x| <= half.x and so on, r up to `disc` [m]; or
/// the hull of `points` where there are any.
struct ConvexCore {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double disc = 0;
  std::vector<Eigen::Vector3d> points{};
};

/// Nearest points, or those that have the depth when the sets meet.
struct ConvexPair {
  double distance = 0;         ///< minus the depth when they meet [m]
  Eigen::Vector3d on_a, on_b;  ///< world [m]
  Eigen::Vector3d normal;      ///< unit, along which b leaves a
};
ConvexPair convex_pair(const ConvexCore& a, const Eigen::Isometry3d& pose_a, const ConvexCore& b,
                       const Eigen::Isometry3d& pose_b);

}  // namespace ayumi
