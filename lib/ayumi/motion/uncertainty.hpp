#pragma once
// Uncertainty of a robot, its ground and its disturbances: named quantities, each with a
// distribution, and where the numbers of the distribution come from. docs/formats.md, "Studies",
// specifies the file.

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
  double low = 0, high = 0;          ///< of a uniform or truncated distribution
  double mean = 0, deviation = 0;    ///< of a normal distribution, before it is truncated
  std::vector<double> values = {};   ///< of a choice
  std::vector<double> weights = {};  ///< of these values; empty: all alike
};

/// The value below which a share u of the draws lies, u in (0, 1); for a choice the value at that
/// share of the weights, in the order of the list.
double quantile(const Distribution& distribution, double u);

enum class UncertainKind {
  mass,            ///< factor on mass and inertia of a link
  cog,             ///< displacement of a link's centre of mass along an axis of the link [m]
  inertia,         ///< factor on a link's inertia about its centre of mass
  friction,        ///< Coulomb coefficient of the ground
  sole_stiffness,  ///< factor
  sole_damping,    ///< factor on the ratio of damping to stiffness
  slope,           ///< of the ground about an axis, in addition to that of the pattern [rad]
  bumps,           ///< depth of the hollows of an uneven ground [m]
  servo_kp,        ///< factor
  servo_kd,        ///< factor
  servo_friction,  ///< dry friction in addition to the servo's own [N m]
  servo_delay,     ///< of the targets, in place of the servo's own [s]
  backlash,        ///< whole play, in place of the servo's own [rad]
  encoder_offset,  ///< error of the zero of an encoder [rad]
  sensor_noise,    ///< factor on the noise of all sensors
  attitude_bias,   ///< about an axis, in addition to the sensor's own [rad]
  gyro_bias,       ///< about an axis of the sensor [rad/s]
  load_bias,       ///< of every load cell [N]
  sensor_latency,  ///< of all sensors, in place of the robot's own [s]
  payload,         ///< mass of a load that a link carries [kg]
  push_size,       ///< impulse of a push [N s, or capture bounds]
  push_direction,  ///< of a push, from forward to the left [rad]
  push_time,       ///< start of a push [s]; a number of a phase where the push names phases
  push_link        ///< number of the link in UncertainPush::links
};

/// Name of the kind in files, the thing on which it acts, and its unit.
struct UncertainKindInfo {
  UncertainKind kind;
  std::string name;
  enum class Target { none, link, joint } target;
  bool axis;     ///< an axis "x", "y" (or "z") belongs to it
  bool angle;    ///< its values have the angle unit of the file
  double least;  ///< the least meaningful value
  std::string meaning;
};
/// Of all kinds that are listed as quantities; those of pushes are not.
const std::vector<UncertainKindInfo>& uncertain_kinds();
const UncertainKindInfo& info(UncertainKind kind);

/// One quantity.
struct UncertainQuantity {
  std::string name;  ///< one of its kind in the study
  UncertainKind kind = UncertainKind::mass;
  std::string on = {};  ///< link or joint, with * for any text; "trunk"; empty: all
  int axis = 0;         ///< 0 x, 1 y, 2 z
  bool each = false;    ///< every link or joint has a value of its own; else all have the same
  std::array<double, 3> point = {0, 0, 0};  ///< of a payload, link frame [m]
  Distribution distribution = {};
  std::string factor = {};  ///< factor that this quantity shares with others; empty: none
  double correlation = 0;   ///< with that factor, of the normal numbers behind both
  std::string source = {};  ///< where the numbers come from
  SourcePlace place = {};   ///< for messages
};

/// A push that acts once during each run.
struct UncertainPush {
  std::string name;
  bool bounds = false;     ///< the size is in capture bounds, else in N s
  double duration = 0.02;  ///< [s]
  /// The time is the number of one of the phases of a push study in which the robot walks, all
  /// with the same probability.
  bool phases = false;
  std::vector<std::string> links = {"cog"};
  /// size, direction, time, link, each with its own distribution.
  UncertainQuantity size, direction, time, link;
};

/// A declared factor, which several quantities share.
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

/// True when a source says that the numbers are assumed.
bool is_assumed(const std::string& source);

}  // namespace ayumi
