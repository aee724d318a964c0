#pragma once
// Contacts of the robot with itself: the pairs of bodies that the check considers, the pairs of
// their shapes that are near each other, and the points in which these touch.

#include <vector>

#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/geometry/contact_patch.hpp"

namespace ayumi {

/// A point at which two bodies touch, or may touch before the step ends.
struct LinkTouch {
  long key = 0;              ///< number of the point, the same in the next step
  int a = 0, b = 0;          ///< indices of the bodies
  Eigen::Vector3d position;  ///< position in the world [m]
  Eigen::Vector3d normal;    ///< unit vector from b to a, in the world
  double gap = 0;            ///< gap, negative inside [m]
};

/// The distance of two bodies is computed only when they may have come near each other since the
/// last computation; their speeds bound how far they have moved. The line of the smallest distance
/// at the last computation then usually shows that they are still apart, which saves the exact
/// distance.
class LinkContacts {
 public:
  explicit LinkContacts(const RobotModel& model);

  /// The collision shapes of a body.
  const std::vector<CollisionModel::PlacedCollider>& shapes(int body) const {
    return shapes_.shapes(body);
  }

  /// A sphere that contains the collision shapes of a body: its centre in the body's frame, and its
  /// radius, which is 0 without shapes [m].
  const Eigen::Vector3d& center(int body) const { return center_[static_cast<size_t>(body)]; }
  double radius(int body) const { return radius_[static_cast<size_t>(body)]; }

  /// Removes all distances, because the robot was moved elsewhere.
  void reset();

  /// The points with a gap below `near` [m] plus the distance by which the bodies may approach each
  /// other in three steps of `dt` [s], in the order of keys. Needs positions and velocities in
  /// `data`.
  const std::vector<LinkTouch>& find(const RobotData& data, double near, double dt);

 private:
  struct Pair {
    int a = 0, b = 0;
    /// Lower bound at the last computation [m]; negative infinity if it was never computed.
    double clearance = 0;
    double mark = 0;   ///< value of moved_ at the last computation [m]
    size_t first = 0;  ///< index of the first line in lines_
  };
  double apart(const Pair& pair, const RobotData& data, double reach);
  void touch(const Pair& pair, long index, const RobotData& data, double reach);

  CollisionModel shapes_;
  std::vector<Pair> pairs_;
  /// For each pair of shapes of two bodies, the direction of the smallest distance in the frame of
  /// a; zero if it is unknown.
  std::vector<Eigen::Vector3d> lines_;
  std::vector<Eigen::Vector3d> center_;  ///< centre of the shapes of a body, in the body frame
  std::vector<double> radius_;           ///< radius around it; 0 for no shape
  std::vector<int> bodies_;              ///< bodies that belong to a pair
  double moved_ = 0;    ///< upper bound of the approach of two bodies since reset() [m]
  double least_ = 0;    ///< least_ - moved_ is a lower bound of all distances [m]
  double last_dt_ = 0;  ///< duration of the last step [s]
  std::vector<LinkTouch> touches_;
};

}  // namespace ayumi
