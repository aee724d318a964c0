#pragma once
// How deep two simple convex bodies overlap. For a unit vector d the support function of A - B,
//   h(d) = (c_A - c_B).d + r_A(d) + r_B(d),   r(d): reach of a body along d from its centre,
// is how far A must move along -d to be clear of B; the depth is its least value over all d.

#include <Eigen/Geometry>

namespace ayumi {

/// A box, or a cylinder or capsule along its z; all symmetric about their centre. A sphere is a
/// capsule of length 0.
struct Solid {
  enum class Kind { box, cylinder, capsule };
  Kind kind = Kind::box;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< of a box's edges [m]
  double radius = 0, half_length = 0;              ///< of cylinder or capsule [m]
};

/// Depth of two bodies that overlap [m]; negative where a plane parts them. Not below the true
/// depth, and above it by less than 0.1 mm for bodies of some centimetres.
double overlap(const Solid& a, const Eigen::Isometry3d& pose_a, const Solid& b,
               const Eigen::Isometry3d& pose_b);

}  // namespace ayumi
