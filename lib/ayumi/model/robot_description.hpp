#pragma once
// A robot as its files describe it: links and joints of the URDF by name, and soles, servos,
// actuators, encoders, sensors and controller defaults of the sidecar. This is plain data, which
// RobotModel validates.

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Mass properties of one link.
struct Inertia {
  double mass = 0;                                      ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();        ///< in the link frame [m]
  Eigen::Matrix3d about_com = Eigen::Matrix3d::Zero();  ///< link axes [kg m^2]
};

struct LinkDescription {
  std::string name;
  bool has_inertial = false;  ///< the file has an inertia
  Inertia inertia;
  std::vector<PlacedShape> visuals;
  std::vector<PlacedShape> collisions;
};

enum class JointType { fixed, revolute, continuous, prismatic, floating };

struct JointDescription {
  std::string name;
  JointType type = JointType::fixed;
  std::string parent, child;                                 ///< link names
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< joint frame in the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< in the joint frame
  bool has_limits = false;
  double lower = 0, upper = 0;  ///< [rad] or [m]
  double velocity = 0;          ///< [rad/s] or [m/s]; 0: not given
  double effort = 0;            ///< [N m] or [N]; 0: not given
  double damping = 0;           ///< [N m s/rad]
  double friction = 0;          ///< Coulomb [N m]
  std::string mimic;            ///< joint that drives this one
  double mimic_multiplier = 1, mimic_offset = 0;
};

/// Limits of the motors by joint name, under a profile name ("hoap1", "hoap1-strong").
struct ActuatorProfile {
  std::string name;
  std::map<std::string, double> speed;              ///< [rad/s]
  std::map<std::string, double> peak_torque;        ///< [N m]
  std::map<std::string, double> continuous_torque;  ///< RMS over thermal_window [N m]
  double thermal_window = 10.0;                     ///< [s]
};

/// The joint's position loop: torque = kp (target - theta) - kd dtheta. The robot receives
/// positions only; a velocity feed-forward is a lead of kd/kp seconds of the target.
struct ServoDescription {
  double kp = 0;             ///< [N m/rad]
  double kd = 0;             ///< [N m s/rad]
  double rotor_inertia = 0;  ///< reflected through the gear [kg m^2]
  double viscous = 0;        ///< gear and bearing friction [N m s/rad]
  double coulomb = 0;        ///< dry friction [N m]
};

/// A joint on the robot's bus and in its sequence files.
struct EncoderDescription {
  int device = 0;                ///< device id on the bus, 1-based
  double counts_per_degree = 0;  ///< signed: the sign of the joint's positive direction
};

/// A foot: the polygon of its sole.
struct SoleDescription {
  std::string link;  ///< foot link
  /// Pose of the sole frame in the foot link: origin under the ankle on the sole plane, x forward,
  /// z up. Footholds of a pattern are poses of this frame.
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> polygon;  ///< convex, counter-clockwise, in the sole frame [m]
  double stiffness = 0;     ///< of the whole sole on the ground [N/m]; 0: derived from the mass
  double damping_time = 0;  ///< contact damping / stiffness [s]; 0: default
};

struct SensorDescription {
  std::string imu_link;                                    ///< empty: the root link
  Eigen::Vector3d imu_position = Eigen::Vector3d::Zero();  ///< in that link [m]
  double latency = 0;                                      ///< [s]
  double attitude_noise = 0, attitude_bias = 0;            ///< [rad], standard deviation, bias
  double gyro_noise = 0;                                   ///< [rad/s]
  double accelerometer_noise = 0;                          ///< [m/s^2]
  double force_noise = 0;                                  ///< per load cell [N]
  double force_resolution = 0;                             ///< per load cell [N]
  bool encoder_quantisation = false;                       ///< round joint angles to counts
};

/// Controller defaults of this robot for values that a pattern does not set. Dimensionless as in
/// docs/theory.md.
struct ControlDefaults {
  std::map<std::string, double> joint_weight;  ///< diagonal of W by joint name, default 1
  std::map<std::string, double> dtad;          ///< gains by name (q, ka, ks, kd, ...)
  std::map<std::string, double> viip;          ///< gains of VIIP by name
};

struct RobotDescription {
  std::string name;
  std::string urdf_file, sidecar_file;  ///< as resolved; sidecar may be empty
  std::string sha256;                   ///< of the URDF and the sidecar bytes
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
  std::vector<std::string> joint_order;          ///< preferred order of moving joints; may be empty
  std::map<std::string, SoleDescription> soles;  ///< "left", "right"
  std::map<std::string, std::map<std::string, double>> postures;  ///< [rad]; "home" at least
  std::map<std::string, ServoDescription> servos;                 ///< by joint name
  std::vector<ActuatorProfile> profiles;                          ///< the first is the default
  std::map<std::string, EncoderDescription> encoders;
  SensorDescription sensors;
  ControlDefaults control;
  double soft_limit_margin = 0;  ///< inside the position limits [rad]
  double servo_period = 0.001;   ///< [s]
  std::string trunk_link;        ///< empty: the root link
  std::vector<std::pair<std::string, std::string>> collision_ignore;  ///< link pairs never checked
  std::vector<std::string> assumptions;  ///< values that were inferred, in words
};

}  // namespace ayumi
