#pragma once
// The ground a robot meets, as data. Everything lies in the ground's frame: its origin is the
// world's, its z axis the normal of the slope, and it moves with the floor.

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace ayumi {

/// Part of the ground raised to a level top, a convex polygon; friction is the ground's.
struct GroundBlock {
  enum class Kind { rectangle, disc };
  Kind kind = Kind::rectangle;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();     ///< least x, y of a rectangle [m]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();    ///< largest [m]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< of a disc [m]
  double radius = 0;                                 ///< of a disc (an octagon) [m]
  double height = 0;  ///< of the top over the ground's origin, not over the plane [m]
};

/// A rectangle with a friction of its own; of several, the last holds.
struct FrictionPatch {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();   ///< least x, y [m]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();  ///< largest [m]
  double friction = 0;                             ///< Coulomb coefficient
};

/// Heights on a square grid, bilinear between its nodes; outside of it the plane.
struct HeightField {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of node (0, 0) [m]
  double spacing = 0.01;                             ///< [m]
  Eigen::MatrixXd heights{};                         ///< (along x, along y), as of a block [m]
};

enum class MotionShape { ramp, half_sine, sine };

/// A declared motion of the whole floor; several add up.
///   ramp: smoothly (minimum jerk) to the full value within `duration`, and stays there;
///   half_sine: there and back within `duration`;
///   sine: sin(2 pi frequency (t - at)) for `duration`, then back where it began.
struct FloorMotion {
  MotionShape shape = MotionShape::ramp;
  double at = 0, duration = 0;                      ///< [s]
  double frequency = 0;                             ///< of a sine [Hz]
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();   ///< about the world's x and y axis [rad]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< along the world's axes [m]
};

struct World {
  double friction = 0.8;  ///< Coulomb coefficient of the ground
  /// Slope of the ground about the world x and y axis [rad] (rotation vector, plane through the
  /// origin). Gravity stays along -z.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double height = 0;  ///< of the plane over the ground's origin, along its normal [m]
  std::vector<GroundBlock> blocks = {};
  std::vector<FrictionPatch> patches = {};
  std::vector<HeightField> fields = {};  ///< none or one
  std::vector<FloorMotion> motions = {};
};

/// Corners of a block's top in the ground's frame, anticlockwise: 4, or 8 of a disc.
int block_corners(const GroundBlock& block, std::array<Eigen::Vector2d, 8>& corners);

/// The ground's frame in the world at time t [s]: slope and all motions; before 0 as at 0.
Eigen::Isometry3d floor_pose(const World& world, const std::vector<FloorMotion>& further, double t);

}  // namespace ayumi
