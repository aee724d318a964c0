// Sway and squat: both feet stay, and the COG is keyed. Each part is minimum jerk with rest at both
// ends; the COG starts and ends over the middle of the feet.
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

/// Time of rest at both ends for HOAP-1 [s]; scaled with the root of the size. Chosen: 3/omega.
constexpr double kGestureRestTime = 0.5;

double to_hundredth_second(double t) { return 0.01 * std::round(100 * t); }

Vector2d middle_of_feet(const RobotModel& model) {
  Pattern standing;
  standing.phases.push_back({1, Support::both, {}});
  return FootPlan(model, standing).support_center(0).head<2>();
}

Pattern both_feet(const RobotModel& model, const std::string& name, double cog_height) {
  Pattern pattern;
  pattern.name = name;
  pattern.robot = model.name();
  pattern.cog_height = cog_height != 0 ? to_tenth_millimetre(cog_height) : bent_height(model);
  return pattern;
}

}  // namespace

SwayParameters sway_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model);
  SwayParameters p;
  p.side = 1e-3 * std::round(1e3 * size * p.side);
  p.period = to_hundredth_second(std::sqrt(size) * p.period);
  return p;
}

Pattern sway_pattern(const RobotModel& model, const SwayParameters& p) {
  const double leg = leg_length(model);
  require_range("sway", "side", p.side, -0.5 * leg, 0.5 * leg, " m");
  require_range("sway", "forward", p.forward, -0.5 * leg, 0.5 * leg, " m");
  require_range("sway", "period", p.period, 0.2, 60, " s");
  require_range("sway", "cycles", p.cycles, 1, 1000, "");
  Pattern pattern = both_feet(model, "sway, " + std::to_string(p.cycles) + " times", p.cog_height);
  const Vector2d middle = middle_of_feet(model), aside(p.forward, p.side);
  const double rest = to_hundredth_second(std::sqrt(size_beside_hoap1(model)) * kGestureRestTime);
  PatternBuilder writer{pattern};
  const auto at = [&](double t, double share) {
    const Vector2d place = middle + share * aside;
    Keyframe key;
    // An axis without sway gets no keys and is solved from the ZMP.
    if (p.forward != 0) key.cog_x = to_tenth_millimetre(place.x());
    if (p.side != 0) key.cog_y = to_tenth_millimetre(place.y());
    if (p.forward == 0 && p.side == 0) key.zmp = ZmpKey{ZmpKey::Place::center, Vector2d::Zero()};
    writer.add(t, key);
  };
  at(0, 0);
  at(rest, 0);
  double t = rest;
  for (int i = 0; i < 2 * p.cycles; ++i) at(t += p.period / 2, i % 2 == 0 ? 1 : -1);
  at(t += p.period / 2, 0);
  writer.phase(t + rest, Support::both);
  return pattern;
}

SquatParameters squat_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model), slow = std::sqrt(size);
  SquatParameters p;
  p.depth = 1e-3 * std::round(1e3 * size * p.depth);
  p.period = to_hundredth_second(slow * p.period);
  p.hold = to_hundredth_second(slow * p.hold);
  return p;
}

Pattern squat_pattern(const RobotModel& model, const SquatParameters& p) {
  const double leg = leg_length(model);
  require_range("squat", "depth", p.depth, -0.2 * leg, 0.6 * leg, " m");
  require_range("squat", "period", p.period, 0.2, 60, " s");
  require_range("squat", "hold", p.hold, 0, 60, " s");
  require_range("squat", "cycles", p.cycles, 1, 1000, "");
  Pattern pattern = both_feet(model, "squat, " + std::to_string(p.cycles) + " times", p.cog_height);
  const double home = default_cog_height(model, pattern);
  const double rest = to_hundredth_second(std::sqrt(size_beside_hoap1(model)) * kGestureRestTime);
  PatternBuilder writer{pattern};
  writer.key(0, ZmpKey::Place::center);
  const auto at = [&](double t, double height) {
    Keyframe key;
    key.cog_height = to_tenth_millimetre(height);
    writer.add(t, key);
  };
  at(rest, home);
  double t = rest;
  for (int i = 0; i < p.cycles; ++i) {
    at(t += p.period / 2, home - p.depth);
    if (p.hold > 0) at(t += p.hold, home - p.depth);
    at(t += p.period / 2, home);
  }
  writer.phase(t + rest, Support::both);
  return pattern;
}

}  // namespace ayumi
