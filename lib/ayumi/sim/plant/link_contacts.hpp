#pragma once
// Contacts of the robot with itself: the pairs of bodies that the check considers, the pairs of
// their shapes that are near each other, and the points in which these touch.

#include <vector>

#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/geometry/contact_patch.hpp"

namespace ayumi {

/// A point in which two bodies touch, or may touch before the step ends.
struct LinkTouch {
  long key = 0;              ///< name of the point, the same in the next step
  int a = 0, b = 0;          ///< bodies
  Eigen::Vector3d position;  ///< world [m]
  Eigen::Vector3d normal;    ///< from b to a, world, unit
  double gap = 0;            ///< gap, negative inside [m]
};

/// The distance of two bodies is computed only when they may have come near each other since the
/// last computation; their speeds bound how far they have moved. The line of the smallest distance
/// at the last computation then mostly shows that they are still apart, which saves the exact
/// distance.
class LinkContacts {
 public:
  explicit LinkContacts(const RobotModel& model);

  /// Collision shapes of a body.
  const std::vector<CollisionModel::PlacedCollider>& shapes(int body) const {
    return shapes_.shapes(body);
  }

  /// Sphere that contains them: centre in the body's frame, and radius, 0 without shapes [m].
  const Eigen::Vector3d& center(int body) const { return center_[static_cast<size_t>(body)]; }
  double radius(int body) const { return radius_[static_cast<size_t>(body)]; }

  /// Forgets all distances: the robot was moved elsewhere.
  void reset();

  /// The points with a gap below `near` [m] plus the distance that the bodies may approach in three
  /// steps of `dt` [s], in the order of keys. Needs positions and velocities in `data`.
  const std::vector<LinkTouch>& find(const RobotData& data, double near, double dt);

 private:
  struct Pair {
    int a = 0, b = 0;
    double clearance = 0;  ///< lower bound, when last computed [m]; negative infinity: never
    double mark = 0;       ///< moved_ when last computed [m]
    size_t first = 0;      ///< in lines_
  };
  double apart(const Pair& pair, const RobotData& data, double reach);
  void touch(const Pair& pair, long index, const RobotData& data, double reach);

  CollisionModel shapes_;
  std::vector<Pair> pairs_;
  /// For each pair of shapes of two bodies the direction of the smallest distance, a's frame; zero:
  /// not known.
  std::vector<Eigen::Vector3d> lines_;
  std::vector<Eigen::Vector3d> center_;  ///< centre of the shapes of a body, body frame
  std::vector<double> radius_;           ///< 0: no shape
  std::vector<int> bodies_;              ///< bodies that belong to a pair
  double moved_ = 0;    ///< upper bound of the approach of two bodies since reset() [m]
  double least_ = 0;    ///< least_ - moved_ is a lower bound of all distances [m]
  double last_dt_ = 0;  ///< [s]
  std::vector<LinkTouch> touches_;
};

}  // namespace ayumi
