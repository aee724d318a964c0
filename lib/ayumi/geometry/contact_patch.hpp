#pragma once
// Where two convex shapes lie on each other: the corners of what their touching faces share.

#include <Eigen/Geometry>
#include <array>

#include "ayumi/geometry/distance.hpp"

namespace ayumi {

struct PatchPoint {
  int id = 0;                ///< the same while the same corners and edges meet
  Eigen::Vector3d position;  ///< world [m]
  double gap = 0;            ///< along the normal, negative inside [m]
  bool corner_of_b = false;  ///< a corner (or end) of b over a face of a
};

struct ContactPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< along which b leaves a, world
  int count = 0;                                      ///< of points; 0: nothing within reach
  std::array<PatchPoint, 16> points;
};

/// Points of the patch that are not farther apart than `reach` [m]. Where a face of one shape is
/// along the line of contact: what the other's face, edge or corner shares with it, box on box
/// four points and more when they cross; elsewhere (edge across edge, round on round) the one
/// nearest point. A cylinder's end counts as an octagon whose first corner is the one nearest to
/// the other shape.
ContactPatch contact_patch(const Collider& a, const Eigen::Isometry3d& pose_a, const Collider& b,
                           const Eigen::Isometry3d& pose_b, double reach);

}  // namespace ayumi
