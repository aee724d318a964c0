#pragma once
// The contact patch of two convex shapes: the corners of the overlap of their touching faces.

#include <Eigen/Geometry>
#include <array>

#include "ayumi/geometry/distance.hpp"

namespace ayumi {

struct PatchPoint {
  int id = 0;                ///< stays the same while the same corners and edges touch
  Eigen::Vector3d position;  ///< world [m]
  double gap = 0;            ///< along the normal, negative inside [m]
  bool corner_of_b = false;  ///< a corner or end of b on a face of a
};

struct ContactPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< from a to b, world
  int count = 0;                                      ///< number of points; 0: none within reach
  std::array<PatchPoint, 16> points;
};

/// The points of the patch with a gap of at most `reach` [m]. Where a face of one shape is square
/// to the line of contact, these are the corners of its overlap with the other shape's face, edge
/// or corner: four or more for two boxes. In other cases (edge across edge, round on round) it is
/// the nearest point alone. The end of a cylinder is an octagon whose first corner is the one
/// nearest to the other shape.
ContactPatch contact_patch(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                           const Eigen::Isometry3d& pose_b, double reach);

}  // namespace ayumi
