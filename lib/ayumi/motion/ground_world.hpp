#pragma once
// The ground as data. All shapes are in the ground's frame: its origin is that of the world, its z
// axis is the normal of the slope, and it moves with the floor.

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace ayumi {

/// A part of the ground with its own height: a convex polygon. Its friction is that of the ground.
struct GroundBlock {
  enum class Kind { rectangle, disc };
  Kind kind = Kind::rectangle;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();     ///< least x and y of a rectangle [m]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();    ///< largest x and y of a rectangle [m]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< centre of a disc [m]
  double radius = 0;                                 ///< radius of a disc, which is an octagon [m]
  double height = 0;  ///< height of the top over the ground's origin (not over the plane) [m]
};

/// A rectangle with its own friction. Where several overlap, the last one counts.
struct FrictionPatch {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();   ///< least x and y [m]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();  ///< largest x and y [m]
  double friction = 0;                             ///< Coulomb coefficient
};

/// Heights on a square grid, interpolated bilinearly between the nodes. Outside the grid, the
/// ground is the plane.
struct HeightField {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< place of node (0, 0) [m]
  double spacing = 0.01;                             ///< distance between nodes [m]
  /// Heights by node (along x, along y), measured as those of a block [m].
  Eigen::MatrixXd heights{};
};

enum class MotionShape { ramp, half_sine, sine };

/// Displacement of the whole floor by a motion, and its course over time.
///   ramp: smoothly (minimum jerk) to the full value within the duration, where it stays;
///   half_sine: to the full value and back within the duration;
///   sine: sin(2 pi frequency (t - at)) for the duration, then zero.
struct FloorPath {
  MotionShape shape = MotionShape::ramp;
  double frequency = 0;  ///< frequency of a sine [Hz]
  /// Rotation about the world's x and y axes [rad].
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< displacement along the world's axes [m]
};

/// A declared motion of the whole floor; several motions add up.
struct FloorMotion {
  double at = 0, duration = 0;  ///< start and duration [s]
  FloorPath path{};
};

struct World {
  double friction = 0.8;  ///< Coulomb coefficient of the ground
  /// Slope of the ground, as a rotation vector about the world's x and y axes [rad]. The plane goes
  /// through the origin. Gravity stays along -z.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double height = 0;  ///< height of the plane over the ground's origin, along its normal [m]
  std::vector<GroundBlock> blocks = {};
  std::vector<FrictionPatch> patches = {};
  std::vector<HeightField> fields = {};  ///< one height field or none
  std::vector<FloorMotion> motions = {};
};

/// Writes the corners of a block's top in the ground's frame, anticlockwise. Returns their number:
/// 4, or 8 for a disc.
int block_corners(const GroundBlock& block, std::array<Eigen::Vector2d, 8>& corners);

/// The pose of the ground's frame in the world at time t [s]. It follows from the slope, the
/// motions of `world` and the `further` motions, such as those of a scenario. Before time 0, it is
/// the pose at 0.
Eigen::Isometry3d floor_pose(const World& world, const std::vector<FloorMotion>& further, double t);

}  // namespace ayumi
