#include "ayumi/io/pattern/pattern_scope.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/expression.hpp"

namespace ayumi {

const std::map<std::string, std::vector<std::string>>& pattern_keys() {
  static const std::map<std::string, std::vector<std::string>> keys = {
      {"pattern", {"$schema",    "format",  "name",       "robot",    "profile",    "units",
                   "parameters", "include", "postures",   "defaults", "start",      "phases",
                   "keyframes",  "table",   "correction", "world",    "controller", "scenario",
                   "tolerances", "repair",  "uncertainty"}},
      {"postures_file", {"$schema", "format", "robot", "units", "postures"}},
      {"units", {"angle", "length", "time", "mass", "force"}},
      {"defaults", {"interpolation", "posture", "cog_height", "cog_model"}},
      {"start", {"left", "right"}},
      {"phase", {"until", "duration", "support", "swing", "viip"}},
      {"repeated_phases", {"repeat", "count", "phases"}},
      {"viip", {"cog", "cog_velocity", "step", "steps", "velocity", "turn", "jump"}},
      {"jump", {"height", "stoop", "forward", "times", "release"}},
      {"swing", {"foot", "to", "step", "lift"}},
      {"step", {"forward", "side", "up", "turn"}},
      {"foot_pose", {"position", "rpy"}},
      {"repeated_keyframes", {"repeat", "count", "keyframes"}},
      {"keyframe",
       {"t", "after", "interpolation", "posture", "joints", "zmp", "cog", "fz", "torso", "feet",
        "hands", "gaze", "weights"}},
      {"hand", {"position", "direction", "frame"}},
      {"gaze", {"position", "frame"}},
      {"cog", {"x", "y", "height"}},
      {"torso", {"roll", "pitch", "yaw"}},
      {"feet", {"left", "right"}},
      {"world", {"friction", "ground", "blocks", "field", "patches", "motion"}},
      {"ground", {"roll", "pitch", "height"}},
      {"block", {"x", "y", "position", "radius", "height"}},
      {"field", {"origin", "spacing", "heights"}},
      {"patch", {"x", "y", "friction"}},
      {"motion", {"shape", "at", "duration", "frequency", "roll", "pitch", "shift"}},
      {"controller", {"type", "gains"}},
      {"disturbance",
       {"type",     "at",     "duration", "on",      "point",     "frame",   "direction", "impulse",
        "force",    "torque", "shape",    "mass",    "frequency", "roll",    "pitch",     "shift",
        "friction", "foot",   "position", "radius",  "height",    "latency", "gyro",      "load",
        "joint",    "offset", "coulomb",  "viscous", "share"}},
      {"correction", {"begin", "spacing", "columns", "coefficients", "smooth"}},
      {"repair", {"lock", "weights", "trust", "margin", "safety"}},
      {"lock", {"joints", "feet", "keyframes", "windows"}},
      {"study", {"$schema", "format", "name", "units", "uncertainty", "sweep"}},
      {"uncertainty", {"factors", "quantities", "pushes"}},
      {"factor", {"name", "source"}},
      {"quantity",
       {"what", "name", "on", "axis", "each", "point", "uniform", "normal", "truncated", "choice",
        "weights", "factor", "correlation", "source"}},
      {"uncertain_push", {"name", "unit", "size", "direction", "time", "on", "duration"}},
      {"spread",
       {"uniform", "normal", "truncated", "choice", "weights", "factor", "correlation", "source"}},
  };
  return keys;
}

void only_pattern_keys(const JsonNode& node, const std::string& kind) {
  node.only_keys(pattern_keys().at(kind));
}

namespace {

SourcePlace where(const JsonNode& node) { return {node.file(), node.pointer()}; }

double plain_number(const JsonNode& node, PatternScope& scope) {
  if (!node.value().is_string()) return node.number();
  const std::string text = node.string();
  if (!is_expression(text))
    node.complain("expected a number, found the string \"" + text +
                  "\"; write a number without quotation marks. A string can only be an expression "
                  "with a parameter, pi or a function, such as \"${stride}*2\" or \"pi/6\"");
  return evaluate_expression(text, scope.parameters, where(node), &scope.used);
}

}  // namespace

double read_number(const JsonNode& node, PatternScope& scope) {
  const double value = plain_number(node, scope);
  if (std::abs(value) > kLargestNumber)
    node.complain(text::exact(value) + " is out of range; numbers must be from -1e6 to 1e6");
  return value;
}

double read_number(const JsonNode& node, PatternScope& scope, double lower, double upper) {
  const double value = read_number(node, scope);
  if (value < lower)
    node.complain(text::exact(value) + " is too small; the smallest allowed value is " +
                  text::exact(lower));
  if (value > upper)
    node.complain(text::exact(value) + " is too large; the largest allowed value is " +
                  text::exact(upper));
  return value;
}

double read_angle(const JsonNode& node, PatternScope& scope) {
  const double value = read_number(node, scope);
  if (!scope.radians_per_unit)
    node.complain(
        "an angle needs its unit: add \"units\": {\"angle\": \"deg\"} (or \"rad\") at "
        "the top of the file");
  return value * *scope.radians_per_unit;
}

double read_time(const JsonNode& node, PatternScope& scope) {
  const double value = read_number(node, scope, 0, kLargestNumber);
  if (value > kLongestPattern)
    node.complain(text::exact(value) + " is too large; the longest pattern is " +
                  text::exact(kLongestPattern) + " s. Times are in seconds: " + text::exact(value) +
                  " ms are " + text::exact(value / 1000) + " s");
  return value;
}

std::vector<double> read_numbers(const JsonNode& node, PatternScope& scope, size_t least,
                                 size_t most, const std::string& form) {
  if (!node.value().is_array()) node.expect_array();
  if (node.size() < least || node.size() > most)
    node.complain("expected " + form + ", found an array of length " + std::to_string(node.size()));
  std::vector<double> values;
  for (const JsonNode& item : node.items()) values.push_back(read_number(item, scope));
  return values;
}

Eigen::Vector3d read_vector3(const JsonNode& node, PatternScope& scope) {
  const std::vector<double> values = read_numbers(node, scope, 3, 3, "[x, y, z]");
  return {values[0], values[1], values[2]};
}

Foothold read_foothold(const JsonNode& node, PatternScope& scope) {
  Foothold foothold;
  if (node.value().is_object()) {
    only_pattern_keys(node, "foot_pose");
    foothold.position = read_vector3(node.at("position"), scope);
    if (const auto rpy = node.find("rpy")) {
      read_numbers(*rpy, scope, 3, 3, "[roll, pitch, yaw]");
      for (int i = 0; i < 3; ++i)
        foothold.rpy[i] = read_angle(rpy->items()[static_cast<size_t>(i)], scope);
    }
    return foothold;
  }
  const std::vector<double> values =
      read_numbers(node, scope, 2, 4, "[x, y], [x, y, z] or [x, y, z, yaw]");
  for (size_t i = 0; i < std::min<size_t>(3, values.size()); ++i)
    foothold.position[static_cast<Eigen::Index>(i)] = values[i];
  if (values.size() == 4) foothold.rpy.z() = read_angle(node.items()[3], scope);
  return foothold;
}

std::map<std::string, double> read_joint_angles(const JsonNode& node, PatternScope& scope) {
  std::map<std::string, double> angles;
  for (const auto& [joint, value] : node.members()) angles[joint] = read_angle(value, scope);
  return angles;
}

Interpolation read_interpolation(const JsonNode& node) {
  static const std::vector<Interpolation> all = {Interpolation::linear, Interpolation::cubic,
                                                 Interpolation::minimum_jerk, Interpolation::hold,
                                                 Interpolation::spline};
  std::vector<std::string> names;
  for (const Interpolation each : all) names.push_back(name_of(each));
  const std::string name = node.one_of(names);
  for (const Interpolation each : all)
    if (name == name_of(each)) return each;
  return Interpolation::minimum_jerk;
}

void read_units(const JsonNode& root, PatternScope& scope) {
  const auto units = root.find("units");
  if (!units) return;
  only_pattern_keys(*units, "units");
  const auto fixed = [&](const char* key, const char* unit) {
    if (const auto node = units->find(key)) node->one_of({unit});
  };
  fixed("length", "m");
  fixed("time", "s");
  fixed("mass", "kg");
  fixed("force", "N");
  if (const auto angle = units->find("angle"))
    scope.radians_per_unit = angle->one_of({"deg", "rad"}) == "deg" ? kRadiansPerDegree : 1.0;
}

}  // namespace ayumi
