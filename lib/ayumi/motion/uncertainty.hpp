#pragma once
// Uncertainty of a robot, its ground and its disturbances: named quantities, each with a
// distribution and the source of its numbers. docs/formats.md, "Studies", specifies the file.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"

namespace ayumi {

/// Distribution of the values of a quantity.
struct Distribution {
  enum class Kind { uniform, normal, truncated, choice };
  Kind kind = Kind::uniform;
  double low = 0, high = 0;  ///< limits of a uniform or truncated distribution
  /// Mean and standard deviation of a normal distribution, before it is truncated.
  double mean = 0, deviation = 0;
  std::vector<double> values = {};   ///< values of a choice
  std::vector<double> weights = {};  ///< weights of these values; if empty, all are equal
};

/// The value below which a fraction u of the draws lies, for u in (0, 1). For a choice it is the
/// value at that fraction of the weights, in the order of the list.
double quantile(const Distribution& distribution, double u);

enum class UncertainKind {
  mass,            ///< factor on mass and inertia of a link
  cog,             ///< displacement of a link's centre of mass along an axis of the link [m]
  inertia,         ///< factor on a link's inertia about its centre of mass
  friction,        ///< Coulomb coefficient of the ground
  sole_stiffness,  ///< factor on the stiffness of the soles
  sole_damping,    ///< factor on the ratio of damping to stiffness
  slope,           ///< slope of the ground about an axis, in addition to that of the pattern [rad]
  bumps,           ///< depth of the hollows of an uneven ground [m]
  servo_kp,        ///< factor on the servo's kp
  servo_kd,        ///< factor on the servo's kd
  servo_friction,  ///< dry friction in addition to the servo's own [N m]
  servo_delay,     ///< delay of the targets, instead of the servo's own [s]
  backlash,        ///< whole play, instead of the servo's own [rad]
  encoder_offset,  ///< error of the zero of an encoder [rad]
  sensor_noise,    ///< factor on the noise of all sensors
  attitude_bias,   ///< bias about an axis, in addition to the sensor's own [rad]
  gyro_bias,       ///< bias about an axis of the sensor [rad/s]
  load_bias,       ///< bias of every load cell [N]
  sensor_latency,  ///< latency of all sensors, instead of the robot's own [s]
  payload,         ///< mass of a load that a link carries [kg]
  push_size,       ///< impulse of a push [N s, or capture bounds]
  push_direction,  ///< direction of a push, from forward to the left [rad]
  push_time,       ///< start of a push [s]; the number of a phase if the push names phases
  push_link        ///< number of the link in UncertainPush::links
};

/// Name of the kind in files, the thing on which it acts, and its unit.
struct UncertainKindInfo {
  UncertainKind kind;
  std::string name;
  enum class Target { none, link, joint } target;
  bool axis;     ///< a quantity of this kind has an axis "x", "y" (or "z")
  bool angle;    ///< its values have the angle unit of the file
  double least;  ///< the least meaningful value
  std::string meaning;
};
/// Information about all kinds that are listed as quantities; those of pushes are not among them.
const std::vector<UncertainKindInfo>& uncertain_kinds();
const UncertainKindInfo& info(UncertainKind kind);

/// An uncertain quantity.
struct UncertainQuantity {
  std::string name;  ///< name that no other quantity of its kind in the study has
  UncertainKind kind = UncertainKind::mass;
  std::string on = {};  ///< link or joint, where * stands for any text; "trunk"; empty for all
  int axis = 0;         ///< 0 for x, 1 for y, 2 for z
  bool each = false;    ///< every link or joint has a value of its own; else all have the same
  std::array<double, 3> point = {0, 0, 0};  ///< place of a payload in the link's frame [m]
  Distribution distribution = {};
  /// Factor that this quantity shares with others; empty if there is none.
  std::string factor = {};
  /// Correlation between the normal numbers from which this quantity and the factor are drawn.
  double correlation = 0;
  std::string source = {};  ///< where the numbers come from
  SourcePlace place = {};   ///< place for messages
};

/// A push that acts once during each run.
struct UncertainPush {
  std::string name;
  bool bounds = false;     ///< the size is in capture bounds, otherwise in N s
  double duration = 0.02;  ///< duration of the push [s]
  /// Whether the time is the number of a walking phase of a push study; each of these phases has
  /// the same probability.
  bool phases = false;
  std::vector<std::string> links = {"cog"};
  /// Size, direction, time and link, each with its own distribution.
  UncertainQuantity size, direction, time, link;
};

/// A declared factor that several quantities share.
struct UncertainFactor {
  std::string name, source;
  SourcePlace place;
};

struct Uncertainty {
  std::vector<UncertainFactor> factors;
  std::vector<UncertainQuantity> quantities;
  std::vector<UncertainPush> pushes;
  bool empty() const { return quantities.empty() && pushes.empty(); }
};

/// Whether a source says that the numbers are assumed.
bool is_assumed(const std::string& source);

}  // namespace ayumi
