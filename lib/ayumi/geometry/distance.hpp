#pragma once
// Distance between two shapes. Spheres and capsules against each other in closed form; every other
// pair by the Gilbert-Johnson-Keerthi distance, expanding-polytope depth when they overlap
// (convex.hpp). A mesh counts as the box that bounds it in its own axes: larger than the mesh,
// so a clearance is never promised that is not there.

#include <Eigen/Geometry>
#include <memory>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Where two shapes are nearest, or overlap deepest.
struct Closest {
  double clearance = 0;                               ///< as clearance() [m]
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();     ///< world [m]
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();     ///< world [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< along which b leaves a
};

/// A shape made ready for distance queries.
class Collider {
 public:
  explicit Collider(const Shape& shape);
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;
  ~Collider();

  /// Bounding sphere, shape frame [m].
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }

 private:
  friend Closest closest(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                         const Eigen::Isometry3d& pose_b);
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
};

/// Free distance between two placed shapes; minus the depth of their overlap when they meet [m].
double clearance(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                 const Eigen::Isometry3d& pose_b);

/// clearance() and the points that have it: its rate is normal . (velocity of on_b - of on_a).
Closest closest(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                const Eigen::Isometry3d& pose_b);

/// A lower bound of clearance() from the bounding spheres, without looking at the shapes [m].
double clearance_bound(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                       const Eigen::Isometry3d& pose_b);

/// Distance between the segments a0-a1 and b0-b1 [m].
double segment_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                        const Eigen::Vector3d& b0, const Eigen::Vector3d& b1);

}  // namespace ayumi
