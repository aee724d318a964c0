#pragma once
// The disturbances of a scenario.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/ground_world.hpp"

namespace ayumi {

enum class DisturbanceType {
  impulse,         ///< [N s], spread over the duration
  force,           ///< [N]
  torque,          ///< [N m]
  payload,         ///< a mass [kg] at a point of a link
  floor,           ///< the floor tilts or shifts
  friction,        ///< the whole ground, patches included, has this coefficient
  bump,            ///< a disc rises from the ground
  latency,         ///< additional age of every reading [s]
  sensor_bias,     ///< of attitude, gyro and load cells
  encoder_offset,  ///< error of an encoder, for servo and controller [rad, m]
  joint_friction,  ///< additional Coulomb [N m, N] and viscous friction
  gain_loss,       ///< missing fraction of the servo's kp and kd
};
enum class DisturbanceShape { rectangle, half_sine };
enum class DisturbanceFrame { world, link };

/// A scripted disturbance. It acts during whole integrator steps: from step round(at/dt) on for
/// round(duration/dt) steps, at least one; the time integral of an impulse is exact. Lasting
/// disturbances (all but impulse, force, torque and floor) that begin at 0 are already active while
/// the robot settles before the start.
struct Disturbance {
  DisturbanceType type = DisturbanceType::impulse;
  double at = 0;                                         ///< start [s]
  double duration = 0;                                   ///< [s]
  std::string on = "cog";                                ///< "cog" or a link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< on that link, link frame [m]
  DisturbanceFrame frame = DisturbanceFrame::world;      ///< of `direction`
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< normalised on loading
  double magnitude = 0;  ///< in the unit of the type; height of a bump [m]
  DisturbanceShape shape = DisturbanceShape::rectangle;
  FloorMotion floor{};                                  ///< of a floor; times are at, duration
  std::string joint{};                                  ///< of the last three types; "": all
  double viscous = 0;                                   ///< of joint_friction [N m s/rad, N s/m]
  std::optional<Side> foot{};                           ///< of a bump: under this foot's sole
  Eigen::Vector2d place = Eigen::Vector2d::Zero();      ///< of a bump: on the sole or ground [m]
  double radius = 0.01;                                 ///< of a bump [m]
  Eigen::Vector2d tilt_bias = Eigen::Vector2d::Zero();  ///< of the attitude about x and y [rad]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< [rad/s]
  double force_bias = 0;                                ///< of every load cell [N]
};

/// "impulse", "joint_friction", ...
const char* name_of(DisturbanceType type);

/// The motion of the floor in a disturbance of type floor.
FloorMotion floor_motion(const Disturbance& disturbance);

}  // namespace ayumi
