// The goals of VIIP phases.
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

namespace {

constexpr double kMostSteps =
    10000;  // largest number of steps. Chosen: longer than kLongestPattern at 0.36 s each
constexpr double kFastest = 10;  // [m/s], [rad/s]. Chosen: any higher speed is a mistake

int read_count(const JsonNode& node, PatternScope& scope, double most) {
  const double count = read_number(node, scope, 1, most);
  if (count != std::round(count)) node.complain(text::exact(count) + " is not a whole number");
  return static_cast<int>(count);
}

void refuse_too_fast(const JsonNode& velocity, double speed) {
  if (speed > kFastest)
    velocity.complain("the velocity must be at most 10 m/s, but it is " + text::brief(speed) +
                      " m/s");
}

/// `rate` is in rad/s, and the message has the angle unit of the pattern.
void refuse_too_quick(const JsonNode& turn, double rate, double radians_per_unit) {
  const std::string unit = radians_per_unit == 1 ? " rad/s" : " deg/s";
  if (std::abs(rate) > kFastest)
    turn.complain("the turning rate must be at most " +
                  text::brief(kFastest / radians_per_unit, 3) + unit + ", but it is " +
                  text::brief(std::abs(rate) / radians_per_unit, 3) + unit);
}

StepGoal read_steps(const JsonNode& node, PatternScope& scope) {
  StepGoal goal;
  if (const auto step = node.find("step")) {
    step->one_of({"in_place"});
    for (const char* const key : {"velocity", "turn"})
      if (node.has(key))
        node.at(key).complain(
            std::string("\"") + key +
            "\" and \"step\": \"in_place\" exclude each other; remove one of these two keys");
  }
  if (const auto steps = node.find("steps")) goal.steps = read_count(*steps, scope, kMostSteps);
  if (const auto velocity = node.find("velocity")) {
    const std::vector<double> v = read_numbers(*velocity, scope, 2, 2, "[forward, left]");
    goal.velocity = {v[0], v[1]};
    refuse_too_fast(*velocity, goal.velocity.norm());
  }
  if (const auto turn = node.find("turn")) {
    goal.turn = read_angle(*turn, scope);
    refuse_too_quick(*turn, goal.turn, *scope.radians_per_unit);
  }
  return goal;
}

JumpGoal read_jump(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "jump");
  JumpGoal goal;
  const auto read = [&](const char* key, double& value, double low, double high) {
    if (const auto found = node.find(key)) value = read_number(*found, scope, low, high);
  };
  read("height", goal.height, 0.001, 10);
  read("stoop", goal.stoop, 0.001, 10);
  read("forward", goal.forward, -10, 10);
  if (const auto times = node.find("times")) goal.times = read_count(*times, scope, 1000);
  if (const auto release = node.find("release"))
    goal.release = release->one_of({"ref_z", "spring"}) == "ref_z" ? JumpGoal::Release::ref_z
                                                                   : JumpGoal::Release::spring;
  return goal;
}

}  // namespace

ViipGoal read_viip_goal(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "viip");
  const bool walks =
      node.has("step") || node.has("steps") || node.has("velocity") || node.has("turn");
  if (node.has("cog") + node.has("cog_velocity") + node.has("jump") + walks != 1)
    node.complain(
        "expected one goal: {\"cog\": [dx, dy, dz]}, {\"cog_velocity\": [vx, vy, vz]}, {\"step\": "
        "\"in_place\"}, {\"steps\": N, \"velocity\": [vx, vy], \"turn\": w} or {\"jump\": {...}}");
  if (node.has("cog")) return CogGoal{read_vector3(node.at("cog"), scope)};
  if (const auto velocity = node.find("cog_velocity")) {
    const CogVelocityGoal goal{read_vector3(*velocity, scope)};
    refuse_too_fast(*velocity, goal.velocity.norm());
    return goal;
  }
  if (node.has("jump")) return read_jump(node.at("jump"), scope);
  return read_steps(node, scope);
}

}  // namespace ayumi
