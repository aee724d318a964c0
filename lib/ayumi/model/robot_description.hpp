#pragma once
// A robot as its files describe it: links and joints of the URDF by name, and soles, servos,
// actuators, encoders, sensors and controller defaults of the sidecar. This is plain data, which
// RobotModel validates.

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Mass properties of one link.
struct Inertia {
  double mass = 0;                                ///< mass [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< centre of mass in the link frame [m]
  /// Inertia about the centre of mass, in the axes of the link [kg m^2].
  Eigen::Matrix3d about_com = Eigen::Matrix3d::Zero();
};

struct LinkDescription {
  std::string name;
  bool has_inertial = false;  ///< whether the file has an inertia for the link
  Inertia inertia;
  std::vector<PlacedShape> visuals;
  std::vector<PlacedShape> collisions;
};

enum class JointType { fixed, revolute, continuous, prismatic, floating };

struct JointDescription {
  std::string name;
  JointType type = JointType::fixed;
  std::string parent, child;                                 ///< names of the two links
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< joint frame in the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< axis of the joint in the joint frame
  bool has_limits = false;
  double lower = 0, upper = 0;  ///< position limits [rad] or [m]
  double velocity = 0;          ///< speed limit [rad/s] or [m/s]; 0 if it is not given
  double effort = 0;            ///< torque or force limit [N m] or [N]; 0 if it is not given
  double damping = 0;           ///< viscous friction [N m s/rad]
  double friction = 0;          ///< Coulomb friction [N m]
  std::string mimic;            ///< the joint that drives this one
  double mimic_multiplier = 1, mimic_offset = 0;
};

/// Share of the torques in a gear that adds to its dry friction, as in the friction models M3 to M6
/// of M. Duclusaud, G. Passault et al., "Extended Friction Models for the Physics Simulation of
/// Servo Actuators", 2024. With the motor's torque t_m and the torque t_e that everything else
/// exerts on the joint, the friction grows by
///   |external t_e - motor t_m| + s |external_stribeck t_e - motor_stribeck t_m|
/// with the factor s of ServoDescription::stribeck_rate and, where t_e and t_m are opposed, by
///   s external_quadratic t_e^2 where |t_m| > |t_e|, else s motor_quadratic t_m^2.
struct LoadFriction {
  double motor = 0, external = 0;  ///< shares of t_m and t_e [1]
  /// Shares of t_m and t_e in the Stribeck part [1].
  double motor_stribeck = 0, external_stribeck = 0;
  double motor_quadratic = 0, external_quadratic = 0;  ///< shares of t_m^2 and t_e^2 [1/(N m)]
  bool operator==(const LoadFriction&) const = default;
};

/// A position servo. It receives positions only. The target that acts is the one that it received
/// `delay` seconds ago. phi is the angle of the motor behind the gear; if the gear has neither
/// backlash nor stiffness, phi is the angle of the joint. The servo reads theta = phi - offset. Its
/// error e is target - theta, reduced by the dead band; within the dead band, e is zero. The motor
/// gives
///   torque = kp e - kd dphi,   or with an inner speed loop   kd (clamp(kp / kd e) - dphi),
/// limited by the profile's peak torque and by the motor's voltage. A velocity feed-forward is a
/// lead of delay + kd/kp seconds of the target. For a sliding joint, read m instead of rad.
struct ServoDescription {
  double kp = 0;             ///< stiffness of the position loop [N m/rad]
  double kd = 0;             ///< damping of the position loop [N m s/rad]
  double rotor_inertia = 0;  ///< inertia of the rotor, reflected through the gear [kg m^2]
  double viscous = 0;        ///< viscous friction of gear and bearing [N m s/rad]
  double coulomb = 0;        ///< dry friction [N m]
  double delay = 0;          ///< transport delay of the target [s], any number of ticks
  /// Largest speed that the position loop requests from the inner speed loop [rad/s]; 0 for no
  /// bound.
  double speed_command_limit = 0;
  /// Dry friction at rest in addition to `coulomb` [N m]; at the rate v it is s times as large,
  /// with s = exp(-(|v| / stribeck_rate)^stribeck_exponent).
  double stribeck_torque = 0;
  /// Rate in the decay above [rad/s], at which s is 1/e; 0 for no Stribeck effect.
  double stribeck_rate = 0;
  double stribeck_exponent = 2;  ///< exponent of the decay [1]
  LoadFriction load = {};
  double backlash = 0;  ///< whole play between motor and joint [rad]
  /// Stiffness of the gear [N m/rad]; 0 for a stiff gear, or for kGearStiffness kp if there is
  /// backlash.
  double gear_stiffness = 0;
  double gear_damping = 0;  ///< damping of the gear [N m s/rad]
  /// Largest torque at rest: torque constant times voltage / resistance [N m]; 0 for no bound.
  double stall_torque = 0;
  double back_emf = 0;   ///< loss of torque with speed: torque constant^2 / resistance [N m s/rad]
  double dead_band = 0;  ///< half width of the dead band [rad]
  bool quantized = false;  ///< whether target and reading are whole counts of the encoder
  double offset = 0;       ///< offset of the encoder's zero on this individual robot [rad]
  bool operator==(const ServoDescription&) const = default;

  /// Time by which a slowly moving joint is behind its target [s].
  double lag() const { return delay + (kp > 0 ? kd / kp : 0.0); }
  bool has_gear() const { return backlash > 0 || gear_stiffness > 0; }
};

/// Limits and servos of the joints by name, under a profile name ("hoap1", "hoap1-strong").
struct ActuatorProfile {
  std::string name;
  std::map<std::string, double> speed;        ///< speed limits by joint [rad/s]
  std::map<std::string, double> peak_torque;  ///< peak torques by joint [N m]
  /// Largest RMS torque over thermal_window [N m].
  std::map<std::string, double> continuous_torque;
  double thermal_window = 10.0;                    ///< time over which torques are averaged [s]
  std::map<std::string, ServoDescription> servos;  ///< servos that replace those of the robot
};

/// A joint on the robot's bus and in its sequence files.
struct EncoderDescription {
  int device = 0;                ///< device id on the bus, 1-based
  double counts_per_degree = 0;  ///< counts with the sign of the joint's positive direction
};

/// Columns of a file with which the robot's own programs exchange targets or measured angles: one
/// row per frame, without a head row.
struct SequenceLayout {
  std::string name;
  /// Columns around those of the motors: "interval" (milliseconds to the next row, first column
  /// only), a fixed text ("2", "60", "R"), or "*" for anything, which can be read only.
  std::vector<std::string> before, after;
  int motors = 0;  ///< number of motor columns, in the order of the devices from 1 on
  /// Whether angles are radians with the signs of the encoders, and not counts.
  bool radians = false;
  /// Intervals that the robot accepts [ms]; empty if it accepts any.
  std::vector<int> intervals_ms;

  bool has_interval() const { return !before.empty() && before.front() == "interval"; }
  size_t columns() const { return before.size() + static_cast<size_t>(motors) + after.size(); }
};

/// Where a sole comes from: a file states it, or it was inferred from the shapes of the foot, or
/// from its mass and inertia.
enum class SoleSource { stated, shapes, inertias };

/// A foot: the polygon of its sole.
struct SoleDescription {
  std::string link;  ///< link of the foot
  /// Pose of the sole frame in the foot link: origin under the ankle on the sole plane, x forward,
  /// z up. Footholds of a pattern are poses of this frame.
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> polygon;  ///< convex, counter-clockwise, in the sole frame [m]
  /// Stiffness of the whole sole on the ground [N/m]; 0 if it is derived from the mass.
  double stiffness = 0;
  double damping_time = 0;  ///< ratio of contact damping to stiffness [s]; 0 for the default
  /// Whether stiffness and damping time are not those of a file but were derived from the mass.
  bool softness_derived = false;
  SoleSource source = SoleSource::stated;

  bool states_softness() const { return stiffness > 0 && !softness_derived; }
};

/// How recorded readings of a robot's load cells become forces. Polynomials begin with the highest
/// power.
struct LoadCells {
  std::vector<int> columns;  ///< columns of a recording without a head row, counted from 1
  /// Polynomials of the load of each cell over its reading, in any unit.
  std::vector<std::vector<double>> cells;
  std::vector<double> force;  ///< polynomial of the force over the sum of the loads [N]
};

/// How recorded readings of a sensor with three axes become values: value = scale (reading - zero).
struct AxisReadings {
  /// Columns of x, y and z, counted from 1; empty if the recording has none.
  std::vector<int> columns;
  Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< factor [m/s^2 or rad/s per reading]
};

/// How the reading of a load cell depends on the force on it, in this order (sim/load_cell).
struct CellResponse {
  double dead_zone = 0;   ///< force below which the reading is 0; subtracted from larger forces [N]
  double hysteresis = 0;  ///< difference of the reading between unloading and loading [N]
  double gain = 1;        ///< reading divided by the force that is left [1]
  double saturation = 0;  ///< largest reading [N]; 0 for no bound
  bool operator==(const CellResponse&) const = default;
};

struct SensorDescription {
  std::string imu_link;  ///< link that carries the sensor; empty for the root link
  /// Position of the sensor in this link [m].
  Eigen::Vector3d imu_position = Eigen::Vector3d::Zero();
  double latency = 0;  ///< latency of all sensors [s]
  /// Latencies of the joint angles, of attitude and gyro, and of the load cells, which replace
  /// `latency` [s].
  std::optional<double> encoder_latency, imu_latency, force_latency;
  /// Standard deviation and bias of the attitude [rad].
  double attitude_noise = 0, attitude_bias = 0;
  double gyro_noise = 0;           ///< standard deviation of the gyro [rad/s]
  double accelerometer_noise = 0;  ///< standard deviation of the accelerometer [m/s^2]
  double force_noise = 0;          ///< standard deviation of a load cell [N]
  double force_resolution = 0;     ///< resolution of a load cell [N]
  /// Number of readings of a load cell, one in every tick, whose mean is reported.
  int force_readings = 1;
  /// For "left" and "right", a response for each corner of the sole, or one for all corners; empty
  /// if the cells are exact.
  std::map<std::string, std::vector<CellResponse>> force_cells;
  bool encoder_quantisation = false;            ///< whether joint angles are rounded to counts
  std::map<std::string, LoadCells> load_cells;  ///< load cells for "left" and "right"
  AxisReadings accelerometer, gyro;

  /// Age of the oldest quantity that a controller with ticks of this length receives [s]. A mean of
  /// N readings is as old as its middle, (N - 1)/2 ticks.
  double oldest(double tick) const {
    const double force = force_latency.value_or(latency) + 0.5 * (force_readings - 1) * tick;
    return std::max({force, encoder_latency.value_or(latency), imu_latency.value_or(latency)});
  }
  /// Gives every quantity this latency [s].
  void set_latency(double age) {
    latency = age;
    encoder_latency = imu_latency = force_latency = std::nullopt;
  }
};

/// Controller defaults of this robot for values that a pattern does not set. Dimensionless as in
/// docs/theory.md.
struct ControlDefaults {
  std::map<std::string, double> joint_weight;  ///< diagonal of W by joint name; 1 for other joints
  std::map<std::string, double> dtad;  ///< gains of the DTAD law by name (q, ka, ks, kd, ...)
  std::map<std::string, double> viip;  ///< gains of VIIP by name
};

struct RobotDescription {
  std::string name;
  std::string urdf_file, sidecar_file;  ///< the files as they were found; the sidecar may be empty
  std::string sha256;                   ///< hash of the bytes of the URDF and the sidecar
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
  std::vector<std::string> joint_order;          ///< preferred order of moving joints; may be empty
  std::map<std::string, std::string> aliases;    ///< joint names by the names that motion files use
  std::map<std::string, SoleDescription> soles;  ///< soles "left" and "right"
  /// Angles [rad]; "home" is always there.
  std::map<std::string, std::map<std::string, double>> postures;
  /// Places of the angles by posture and joint, because an angle may be in the file of a base. An
  /// angle without a place is at /postures in the sidecar.
  std::map<std::string, std::map<std::string, SourcePlace>> angle_places = {};
  std::map<std::string, ServoDescription> servos;  ///< servos by joint name
  bool servos_inferred = false;  ///< whether the servos were inferred because the files state none
  std::vector<ActuatorProfile> profiles;  ///< profiles; the first is the default
  std::map<std::string, EncoderDescription> encoders;
  std::vector<SequenceLayout> layouts;  ///< layouts; the first one with an interval is written
  SensorDescription sensors;
  ControlDefaults control;
  double soft_limit_margin = 0;  ///< distance that is kept inside the position limits [rad]
  double servo_period = 0.001;   ///< period of the servo targets [s]
  std::string trunk_link;        ///< link of the trunk; empty for the root link
  /// Pairs of links that are never checked.
  std::vector<std::pair<std::string, std::string>> collision_ignore;
  /// Meshes that were left out, each with its link, in words.
  std::vector<std::string> missing_meshes;
  std::vector<std::string> assumptions;  ///< values that were inferred, in words

  /// Whether the files of the robot state the stiffness of all soles.
  bool states_softness_of_soles() const {
    return std::all_of(soles.begin(), soles.end(),
                       [](const auto& sole) { return sole.second.states_softness(); });
  }
};

}  // namespace ayumi
