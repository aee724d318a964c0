#pragma once
// The contact patch of two convex shapes: the corners of the overlap of their touching faces.

#include <Eigen/Geometry>
#include <array>

#include "ayumi/geometry/distance.hpp"

namespace ayumi {

struct PatchPoint {
  int id = 0;                ///< number that stays the same while the same corners and edges touch
  Eigen::Vector3d position;  ///< world [m]
  double gap = 0;            ///< distance along the normal, negative inside [m]
  bool corner_of_b = false;  ///< whether it is a corner or end of b on a face of a
};

struct ContactPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector from a to b, in the world
  int count = 0;                                      ///< number of points; 0: none is within reach
  std::array<PatchPoint, 16> points;
};

/// The points of the patch with a gap of at most `reach` [m]. If a face of one shape is
/// perpendicular to the line of contact, these are the corners of its overlap with the other
/// shape's face, edge or corner: four or more for two boxes. In other cases (edge across edge, or
/// two round shapes), it is only the nearest point. The end of a cylinder is an octagon whose first
/// corner is the one nearest to the other shape.
ContactPatch contact_patch(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                           const Eigen::Isometry3d& pose_b, double reach);

}  // namespace ayumi
