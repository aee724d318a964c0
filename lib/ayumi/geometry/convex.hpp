#pragma once
// Distance and penetration depth of two convex sets: the Gilbert-Johnson-Keerthi algorithm for the
// distance, an expanding polytope for the depth. A set is a box, a segment, a point, an upright
// cylinder or the convex hull of points.

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

/// The nearest points; the points with the penetration depth when the sets overlap.
struct ConvexPair {
  double distance = 0;         ///< minus the depth when they overlap [m]
  Eigen::Vector3d on_a, on_b;  ///< world [m]
  Eigen::Vector3d normal;      ///< unit, from a to b
};
ConvexPair convex_pair(const ConvexCore& a, const Eigen::Isometry3d& pose_a, const ConvexCore& b,
                       const Eigen::Isometry3d& pose_b);

}  // namespace ayumi
