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
enum class PushShape { rectangle, half_sine };  ///< course of the force over the duration
enum class PushFrame { world, link };

/// A force or a torque on the robot.
struct Push {
  PushKind kind = PushKind::impulse;
  double magnitude = 0;    ///< impulse [N s], or largest force [N] or torque [N m]
  std::string on = "cog";  ///< "cog" or a link name
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< point on that link, in the link's frame [m]
  PushFrame frame = PushFrame::world;               ///< frame of `direction`
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< direction of the push, a unit vector
  PushShape shape = PushShape::rectangle;
};

/// A point mass that a link carries.
struct Payload {
  std::string on{};                                 ///< name of the link
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< place in the link's frame [m]
  double mass = 0;                                  ///< mass of the load [kg]
};

/// A new coefficient of friction of the whole ground, its patches included.
struct FrictionChange {
  double friction = 0;
};

/// A disc that rises from the ground: under a foot, where the foot is at that moment, or at a given
/// place.
struct Bump {
  std::optional<Side> foot{};
  /// Place in the sole's frame or in the ground's frame [m].
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double radius = 0.01;  ///< radius of the disc [m]
  double height = 0;     ///< height over the plane of the ground [m]
};

/// A latency that is added to every reading of the sensors.
struct Latency {
  double latency = 0;  ///< the added latency [s]
};

/// Constant errors of the sensors.
struct SensorBias {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< error of the attitude about x and y [rad]
  /// Error of the angular velocity, in the frame of the IMU [rad/s].
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
  double load = 0;  ///< error of every load cell [N]
};

/// The amount by which an encoder reads too much, both for the servo and for the controller.
struct EncoderOffset {
  std::string joint{};  ///< joint name; "" for all joints
  double offset = 0;    ///< the amount [rad, m]
};

/// Friction of a joint that is added to its own.
struct JointFriction {
  std::string joint{};  ///< joint name; "" for all joints
  double coulomb = 0;   ///< dry friction [N m, N]
  double viscous = 0;   ///< viscous friction [N m s/rad, N s/m]
};

/// A servo that has lost a fraction of kp and kd.
struct GainLoss {
  std::string joint{};  ///< joint name; "" for all joints
  double share = 0;     ///< lost fraction, from 0 to 1
};

/// A scripted disturbance. It acts during whole integrator steps: from step round(at/dt) on for
/// round(duration/dt) steps, at least one; the time integral of an impulse is exact. Lasting
/// disturbances (all but pushes and motions of the floor) that begin at 0 are already active while
/// the robot settles before the start.
struct Disturbance {
  double at = 0;        ///< start [s]
  double duration = 0;  ///< duration [s]
  std::variant<Push, Payload, FloorPath, FrictionChange, Bump, Latency, SensorBias, EncoderOffset,
               JointFriction, GainLoss>
      what{};
};

/// The name of a push in pattern files: "impulse", "force" or "torque".
const char* name_of(PushKind kind);

/// The name of a disturbance in pattern files, such as "impulse", "payload" or "joint_friction".
const char* name_of(const Disturbance& disturbance);

/// The motions of the floor among the disturbances.
std::vector<FloorMotion> floor_motions(const std::vector<Disturbance>& scenario);

}  // namespace ayumi
