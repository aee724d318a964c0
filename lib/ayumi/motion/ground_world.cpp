#include "ayumi/motion/ground_world.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The fraction of a floor motion's full value that is reached at time t.
double share_of(const FloorMotion& motion, double t) {
  const double since = t - motion.at;
  if (since < 0) return 0;
  if (motion.path.shape == MotionShape::ramp) {
    if (since >= motion.duration) return 1;
    const double s = since / motion.duration;
    return s * s * s * (10 - 15 * s + 6 * s * s);
  }
  if (since >= motion.duration) return 0;
  return motion.path.shape == MotionShape::sine
             ? elementary::sin(2 * M_PI * motion.path.frequency * since)
             : elementary::sin(M_PI * since / motion.duration);
}

}  // namespace

int block_corners(const GroundBlock& block, std::array<Vector2d, 8>& corners) {
  if (block.kind == GroundBlock::Kind::rectangle) {
    corners[0] = block.low;
    corners[1] = {block.high.x(), block.low.y()};
    corners[2] = block.high;
    corners[3] = {block.low.x(), block.high.y()};
    return 4;
  }
  for (int i = 0; i < 8; ++i) {
    const double a = M_PI * (0.125 + 0.25 * i);
    corners[static_cast<size_t>(i)] =
        block.center + block.radius * Vector2d(elementary::cos(a), elementary::sin(a));
  }
  return 8;
}

Eigen::Isometry3d floor_pose(const World& world, const std::vector<FloorMotion>& further,
                             double t) {
  Vector3d tilt(world.slope.x(), world.slope.y(), 0), shift = Vector3d::Zero();
  for (const std::vector<FloorMotion>* list : {&world.motions, &further})
    for (const FloorMotion& motion : *list) {
      const double share = share_of(motion, std::max(t, 0.0));
      tilt.head<2>() += share * motion.path.tilt;
      shift += share * motion.path.shift;
    }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = exp_rotation(tilt).toRotationMatrix();
  pose.translation() = shift;
  return pose;
}

}  // namespace ayumi
