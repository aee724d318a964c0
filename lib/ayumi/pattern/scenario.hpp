#pragma once
// What happens to the robot from outside: the world it meets and the disturbances of a scenario.

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace ayumi {

struct World {
  double friction = 0.8;  ///< Coulomb coefficient of the ground
  /// Slope of the ground about the world x and y axis [rad] (rotation vector, plane through the
  /// origin). Gravity stays along -z.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

enum class DisturbanceType { impulse, force, torque };
enum class DisturbanceShape { rectangle, half_sine };
enum class DisturbanceFrame { world, link };

/// A scripted push. It acts on whole integrator steps: from round(at/dt) for round(duration/dt) of
/// them, at least one; an impulse is spread so that its time integral is exact.
struct Disturbance {
  DisturbanceType type = DisturbanceType::impulse;
  double at = 0;                                         ///< start [s]
  double duration = 0;                                   ///< [s]
  std::string on = "cog";                                ///< "cog" or a link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< on that link, link frame [m]
  DisturbanceFrame frame = DisturbanceFrame::world;      ///< of `direction`
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< normalised on loading
  double magnitude = 0;                                  ///< [N s], [N] or [N m] by type
  DisturbanceShape shape = DisturbanceShape::rectangle;
};

/// Which controller, with which numbers; empty gains mean the robot's defaults.
struct ControllerSpec {
  std::string type = "dtad";  ///< "none", "dtad", "dtad-literal", "viip", "viip-nofeedback"
  std::vector<std::pair<std::string, double>> gains;
};

}  // namespace ayumi
