#pragma once
// Where the robot touches itself: the pairs of bodies that the check looks at too, their shapes
// near each other and the points they meet in.

#include <vector>

#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/geometry/contact_patch.hpp"

namespace ayumi {

/// One point in which two bodies meet, or may within the step.
struct LinkTouch {
  long key = 0;              ///< the same in the next step
  int a = 0, b = 0;          ///< bodies
  Eigen::Vector3d position;  ///< world [m]
  Eigen::Vector3d normal;    ///< along which a leaves b
  double gap = 0;            ///< negative inside [m]
};

/// Distances are computed only where two bodies may have come near since they were last: what they
/// have moved since is bounded by their speeds, so that a robot whose limbs are apart pays for a
/// sum per body. Where they may have, the line along which their shapes were apart the last time
/// mostly tells that they still are.
class LinkContacts {
 public:
  explicit LinkContacts(const RobotModel& model);

  /// The collision shapes of a body.
  const std::vector<CollisionModel::PlacedCollider>& shapes(int body) const {
    return shapes_.shapes(body);
  }

  /// A sphere around them: centre in the body's frame, and radius, 0 without shapes [m].
  const Eigen::Vector3d& center(int body) const { return center_[static_cast<size_t>(body)]; }
  double radius(int body) const { return radius_[static_cast<size_t>(body)]; }

  /// Forgets what it knows of distances: the robot is somewhere else.
  void reset();

  /// Points nearer than `near` [m] plus what the bodies may approach in three steps of `dt` [s];
  /// needs positions and velocities. In the order of keys.
  const std::vector<LinkTouch>& find(const RobotData& data, double near, double dt);

 private:
  struct Pair {
    int a = 0, b = 0;
    double clearance = 0;  ///< at least, when last computed [m]; negative infinity: never
    double mark = 0;       ///< `moved_` then
    size_t first = 0;      ///< of its lines_
  };
  double apart(const Pair& pair, const RobotData& data, double reach);
  void touch(const Pair& pair, long index, const RobotData& data, double reach);

  CollisionModel shapes_;
  std::vector<Pair> pairs_;
  /// Along which b was apart from a, in a's frame, for every shape of the one and of the other;
  /// zero: not known.
  std::vector<Eigen::Vector3d> lines_;
  std::vector<Eigen::Vector3d> center_;  ///< of a body's shapes, body frame
  std::vector<double> radius_;           ///< 0: no shape
  std::vector<int> bodies_;              ///< that are in a pair
  double moved_ = 0;    ///< most by which two bodies can have approached since reset() [m]
  double least_ = 0;    ///< no pair is nearer than this less what moved_ has grown to
  double last_dt_ = 0;  ///< [s]
  std::vector<LinkTouch> touches_;
};

}  // namespace ayumi
