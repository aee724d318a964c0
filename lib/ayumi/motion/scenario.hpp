#pragma once
// The disturbances of a scenario: when each acts, and what it is. Every kind has its own struct.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/ground_world.hpp"

namespace ayumi {

enum class PushKind { impulse, force, torque };
enum class PushShape { rectangle, half_sine };  ///< of the force over the duration
enum class PushFrame { world, link };

/// A force or a torque on the robot.
struct Push {
  PushKind kind = PushKind::impulse;
  double magnitude = 0;    ///< impulse [N s]; largest force [N] or torque [N m]
  std::string on = "cog";  ///< "cog" or a link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< on that link, link frame [m]
  PushFrame frame = PushFrame::world;                    ///< of `direction`
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector
  PushShape shape = PushShape::rectangle;
};

/// A point mass that a link carries.
struct Payload {
  std::string on{};                                 ///< link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< link frame [m]
  double mass = 0;                                  ///< [kg]
};

/// The whole ground, its patches included, has this coefficient of friction.
struct FrictionChange {
  double friction = 0;
};

/// A disc that rises from the ground: under a foot, where the foot is then, or at a place.
struct Bump {
  std::optional<Side> foot{};
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< sole's frame, or the ground's [m]
  double radius = 0.01;                             ///< [m]
  double height = 0;                                ///< over the plane of the ground [m]
};

/// Adds this latency to every reading of the sensors.
struct Latency {
  double latency = 0;  ///< [s]
};

/// Constant errors of the sensors.
struct SensorBias {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< of the attitude about x and y [rad]
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();  ///< frame of the IMU [rad/s]
  double load = 0;                                 ///< of every load cell [N]
};

/// Amount by which an encoder reads too much, for the servo and the controller.
struct EncoderOffset {
  std::string joint{};  ///< "": all joints
  double offset = 0;    ///< [rad, m]
};

/// Friction of a joint in addition to its own.
struct JointFriction {
  std::string joint{};  ///< "": all joints
  double coulomb = 0;   ///< [N m, N]
  double viscous = 0;   ///< [N m s/rad, N s/m]
};

/// A servo that has lost a fraction of kp and kd.
struct GainLoss {
  std::string joint{};  ///< "": all joints
  double share = 0;     ///< 0 to 1
};

/// A scripted disturbance. It acts during whole integrator steps: from step round(at/dt) on for
/// round(duration/dt) steps, at least one; the time integral of an impulse is exact. Lasting
/// disturbances (all but pushes and motions of the floor) that begin at 0 are already active while
/// the robot settles before the start.
struct Disturbance {
  double at = 0;        ///< start [s]
  double duration = 0;  ///< [s]
  std::variant<Push, Payload, FloorPath, FrictionChange, Bump, Latency, SensorBias, EncoderOffset,
               JointFriction, GainLoss>
      what{};
};

/// "impulse", "force", "torque": the name of a push in pattern files.
const char* name_of(PushKind kind);

/// The name of a disturbance in pattern files: "impulse", "payload", "joint_friction", ...
const char* name_of(const Disturbance& disturbance);

/// The motions of the floor among the disturbances.
std::vector<FloorMotion> floor_motions(const std::vector<Disturbance>& scenario);

}  // namespace ayumi
