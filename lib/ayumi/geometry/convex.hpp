#pragma once
// The distance and the penetration depth of two convex sets, by the Gilbert-Johnson-Keerthi
// algorithm for the distance and by an expanding polytope for the depth. A set is a box, a segment,
// a point, an upright cylinder or the convex hull of points.

#include <Eigen/Geometry>
#include <vector>

namespace ayumi {

/// The set of the points (x, y, z) + r (cos, sin, 0) with |x| <= half.x and so on, and r up to
/// `disc` [m]; or the hull of `points` if there are any.
struct ConvexCore {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double disc = 0;
  std::vector<Eigen::Vector3d> points{};
};

/// The nearest points; if the sets overlap, the points of the penetration depth.
struct ConvexPair {
  double distance = 0;         ///< distance, or minus the depth if they overlap [m]
  Eigen::Vector3d on_a, on_b;  ///< points in the world [m]
  Eigen::Vector3d normal;      ///< unit vector from a to b
};
ConvexPair convex_pair(const ConvexCore& a, const Eigen::Isometry3d& pose_a, const ConvexCore& b,
                       const Eigen::Isometry3d& pose_b);

}  // namespace ayumi
