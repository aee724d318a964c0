#pragma once
// Self-collision: the pairs of bodies that are examined, and their distances.

#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/geometry/distance.hpp"

namespace ayumi {

/// The collision shapes of a robot made ready, and the pairs of bodies to look at. Left out are:
/// shapes of one body; parent and child; pairs the robot says to ignore; pairs that overlap in the
/// home posture (touching is not overlapping); and pairs up to three joints apart that are nearer
/// than 5 mm there (housings of one compound joint, made to pass each other).
class CollisionModel {
 public:
  explicit CollisionModel(const RobotModel& model, MeshAs mesh_as = MeshAs::box);

  struct Pair {
    int a = 0, b = 0;  ///< bodies, a < b
  };
  const std::vector<Pair>& pairs() const { return pairs_; }

  struct PlacedCollider {
    Collider collider;
    Eigen::Isometry3d pose;  ///< in the body
  };
  const std::vector<PlacedCollider>& shapes(int body) const {
    return shapes_[static_cast<size_t>(body)];
  }

  /// Clearance of a pair [m]; needs update_positions(). Where the bounding spheres are farther
  /// apart than `skip`, that bound is returned instead.
  double clearance(const Pair& pair, const RobotData& data, double skip) const;

 private:
  std::vector<std::vector<PlacedCollider>> shapes_;  ///< by body
  std::vector<Pair> pairs_;
};

}  // namespace ayumi
