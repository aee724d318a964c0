#pragma once
// What happens to the robot from outside: the disturbances of a scenario.

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
  payload,         ///< a mass [kg] carried at a point of a link
  floor,           ///< the floor tilts or shifts
  friction,        ///< the whole ground, patches included, has this coefficient
  bump,            ///< a disc rises from the ground
  latency,         ///< every reading is this much older [s]
  sensor_bias,     ///< of attitude, gyro and load cells
  encoder_offset,  ///< the encoder reads this much more [rad, m]: servo and controller alike
  joint_friction,  ///< Coulomb [N m, N] and viscous friction more
  gain_loss,       ///< this share of the servo's kp and kd is missing
};
enum class DisturbanceShape { rectangle, half_sine };
enum class DisturbanceFrame { world, link };

/// A scripted disturbance. It acts on whole integrator steps: from round(at/dt) for
/// round(duration/dt) of them, at least one; an impulse is spread so that its time integral is
/// exact. What lasts (everything but impulse, force, torque and floor) and begins at 0 holds
/// already while the robot settles before the start.
struct Disturbance {
  DisturbanceType type = DisturbanceType::impulse;
  double at = 0;                                         ///< start [s]
  double duration = 0;                                   ///< [s]
  std::string on = "cog";                                ///< "cog" or a link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< on that link, link frame [m]
  DisturbanceFrame frame = DisturbanceFrame::world;      ///< of `direction`
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< normalised on loading
  double magnitude = 0;  ///< by type, see there; of a bump its height [m]
  DisturbanceShape shape = DisturbanceShape::rectangle;
  FloorMotion floor{};                                  ///< of a floor; its times are at, duration
  std::string joint{};                                  ///< of the last three types; "" is all
  double viscous = 0;                                   ///< of joint_friction [N m s/rad, N s/m]
  std::optional<Side> foot{};                           ///< a bump under this foot's sole ...
  Eigen::Vector2d place = Eigen::Vector2d::Zero();      ///< ... there, else on the ground [m]
  double radius = 0.01;                                 ///< of a bump [m]
  Eigen::Vector2d tilt_bias = Eigen::Vector2d::Zero();  ///< of the attitude about x and y [rad]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< [rad/s]
  double force_bias = 0;                                ///< of every load cell [N]
};

/// "impulse", "joint_friction", ...
const char* name_of(DisturbanceType type);

/// The floor's motion that a disturbance of type floor is.
FloorMotion floor_motion(const Disturbance& disturbance);

}  // namespace ayumi
