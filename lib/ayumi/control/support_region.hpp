#pragma once
// The support region of planned feet, and the nearest admissible ZMP and vertical force.

#include <algorithm>
#include <array>
#include <vector>

#include "ayumi/math/polygon.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The convex hull of the supporting soles seen from above, in world axes [m].
ConvexPolygon support_polygon(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                              Support support);

/// The height of the ground under two feet [m]: that of the lower foot, because the other one may
/// be lifted.
inline double ground_of(const std::array<Eigen::Isometry3d, 2>& feet) {
  return std::min(feet[0].translation().z(), feet[1].translation().z());
}

/// The support polygon reduced by a margin. It is only computed again if the feet or the support
/// have changed.
class SupportRegion {
 public:
  /// The result is valid until the next call. Allocates nothing once it has met its largest
  /// polygon.
  const ConvexPolygon& update(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                              Support support, double margin);

 private:
  bool known_ = false;
  std::array<Eigen::Isometry3d, 2> feet_;
  Support support_ = Support::both;
  double margin_ = 0;
  ConvexPolygon whole_, region_;
  std::vector<Eigen::Vector2d> points_, scratch_;
};

}  // namespace ayumi
