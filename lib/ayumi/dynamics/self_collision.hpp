#pragma once
// Self-collision: the pairs of bodies that are examined, and their distances.

#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/geometry/distance.hpp"

namespace ayumi {

/// The shape that replaces a mesh: its bounding box, so that no clearance is overestimated, or, for
/// contacts, the convex hull of its outer vertices (mesh_hull.hpp).
enum class MeshAs { box, hull };

/// The collision shapes of a robot, prepared for use, and the pairs of bodies to examine. A foot
/// without collision shapes has a thin box above its sole, because a sole is solid: the check finds
/// soles that overlap, and in the simulator such soles push each other. These pairs are left out:
/// shapes of one body; parent and child; pairs that the sidecar says to ignore; pairs that overlap
/// in the home posture (touching is not overlapping); and pairs up to three joints apart that are
/// nearer than 5 mm in the home posture. Bodies of the last kind are housings of one compound
/// joint, which are made to pass each other.
class CollisionModel {
 public:
  explicit CollisionModel(const RobotModel& model, MeshAs mesh_as = MeshAs::box);

  struct Pair {
    int a = 0, b = 0;  ///< indices of the bodies, a < b
  };
  const std::vector<Pair>& pairs() const { return pairs_; }

  struct PlacedCollider {
    Collider collider;
    Eigen::Isometry3d pose;  ///< pose of the shape in the body
  };
  const std::vector<PlacedCollider>& shapes(int body) const {
    return shapes_[static_cast<size_t>(body)];
  }

  /// The clearance of a pair [m]. If the bounding spheres are farther apart than `skip`, their
  /// distance is returned instead. Needs update_positions().
  double clearance(const Pair& pair, const RobotData& data, double skip) const;

 private:
  std::vector<std::vector<PlacedCollider>> shapes_;  ///< shapes by body
  std::vector<Pair> pairs_;
};

}  // namespace ayumi
