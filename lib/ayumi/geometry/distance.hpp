#pragma once
// Distance between two shapes: in closed form for spheres and capsules, for other pairs by the
// Gilbert-Johnson-Keerthi algorithm and the expanding polytope (convex.hpp). A mesh is replaced by
// its bounding box in its own axes, so that no clearance is overestimated; for contacts it is
// replaced by the convex hull of its outer vertices (mesh_hull.hpp). The normal of a pair points
// from a to b.

#include <Eigen/Geometry>

#include "ayumi/geometry/convex.hpp"
#include "ayumi/geometry/mesh_hull.hpp"
#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// The nearest points of two shapes, or the points of the deepest overlap.
struct Closest {
  double clearance = 0;                               ///< the same as clearance() [m]
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();     ///< point in the world [m]
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();     ///< point in the world [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector from a to b
};

/// A shape prepared for distance queries: all points within `rounding` of a convex core.
class Collider {
 public:
  /// A mesh is its bounding box.
  explicit Collider(const Shape& shape);
  /// A mesh is its convex hull. A flat mesh, whose hull has no faces, is its bounding box.
  Collider(const Shape& shape, const MeshHull& hull);

  /// The bounding sphere in the shape's frame [m]. Its centre is the origin of the core's frame.
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }

  const ConvexCore& core() const { return core_; }
  /// Faces of a hull, in the frame of the core.
  const std::vector<HullFace>& faces() const { return faces_; }
  double rounding() const { return rounding_; }  ///< radius of the rounding [m]
  /// Whether it is a sphere or capsule: a point or a segment along z.
  bool swept() const { return swept_; }
  /// The frame of the core for a shape at `pose`.
  Eigen::Isometry3d core_pose(const Eigen::Isometry3d& pose) const {
    return pose * Eigen::Translation3d(center_);
  }

 private:
  ConvexCore core_;
  std::vector<HullFace> faces_;
  double rounding_ = 0, radius_ = 0;
  bool swept_ = false;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
};

/// The free distance between two placed shapes, or minus the depth of their overlap [m].
double clearance(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                 const Eigen::Isometry3d& pose_b);

/// clearance() with its points. Its rate is normal . (velocity of on_b - velocity of on_a).
Closest closest(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                const Eigen::Isometry3d& pose_b);

/// A lower bound of clearance() that only uses the bounding spheres [m].
double clearance_bound(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                       const Eigen::Isometry3d& pose_b);

/// The gap of the two shapes along a unit vector (world) from a to b [m]. It is a lower bound of
/// clearance(), and equal to clearance() along the normal of closest().
double clearance_along(const Eigen::Vector3d& direction, const Collider& a,
                       const Eigen::Isometry3d& pose_a, const Collider& b,
                       const Eigen::Isometry3d& pose_b);

}  // namespace ayumi
