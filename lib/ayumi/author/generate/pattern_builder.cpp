#include "ayumi/author/generate/pattern_builder.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

/// Height of HOAP-1's COG at its home posture [m]. Source: the sidecar of robots/hoap1.
constexpr double kHoap1Height = 0.245;

/// Legs that are longer than the first fraction of their straight length are bent to the second
/// one. Chosen: a leg at 97 % has 28 deg of knee angle left, too little to move a foot or the COG.
constexpr double kStraightLeg = 0.97, kBentLeg = 0.94;

/// Digits with which a refused value is printed. Derived: a double has 15 exact digits, and
/// conversions of units round the last ones (120 deg becomes 119.99999999999999 deg).
constexpr int kShownDigits = 12;

}  // namespace

double to_millisecond(double t) { return std::round(1e3 * t) / 1e3; }
double to_tenth_millimetre(double x) { return std::round(1e4 * x) / 1e4 + 0.0; }

void require_range(const char* pattern, const char* name, double value, double low, double high,
                   const char* unit) {
  if (value >= low && value <= high) return;
  const auto bound = [](double x) { return x >= 1e3 ? text::fixed(x, 0) : text::brief(x); };
  fail(ErrorCode::usage,
       std::string(pattern) + ": " + name + " " + text::brief(value, kShownDigits) + unit +
           " is out of range. Give a value from " + bound(low) + " to " + bound(high) + unit);
}

void require_cog_height(const char* pattern, double height, double leg) {
  if (height == 0) return;
  try {
    require_range(pattern, "cog_height", height, 0.3 * leg, 2 * leg, " m");
  } catch (const Error& error) {
    throw_with_more(error, ", or 0 for the usual height");
  }
}

double leg_length(const RobotModel& model) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const auto& leg = model.leg(Side::left);
  Vector3d from = data.pose(model.dofs()[leg.front()].body).translation();
  double length = 0;
  for (const int dof : leg) {
    const Vector3d to = data.pose(model.dofs()[dof].body).translation();
    length += (to - from).norm();
    from = to;
  }
  return length + (sole_pose(model, data, Side::left).translation() - from).norm();
}

double home_reach(const RobotModel& model) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const Vector3d hip = data.pose(model.dofs()[model.leg(Side::left).front()].body).translation();
  return (sole_pose(model, data, Side::left).translation() - hip).norm();
}

double bent_height(const RobotModel& model) {
  const double reach = home_reach(model);
  const double leg = leg_length(model);
  if (reach < kStraightLeg * leg) return 0;
  return to_tenth_millimetre(default_cog_height(model, {}) - (reach - kBentLeg * leg));
}

double size_beside_hoap1(const RobotModel& model) {
  return default_cog_height(model, {}) / kHoap1Height;
}

void PatternBuilder::key(double at, ZmpKey::Place place) {
  Keyframe key;
  key.zmp = ZmpKey{place, Eigen::Vector2d::Zero()};
  add(at, key);
}

void PatternBuilder::add(double at, Keyframe key) {
  key.t = to_millisecond(at);
  key.place.inside = "/keyframes/" + std::to_string(pattern.keyframes.size());
  pattern.keyframes.push_back(key);
}

void PatternBuilder::phase(double length, Support support, std::optional<Swing> swing) {
  t += length;
  pattern.phases.push_back({to_millisecond(t), support, swing});
}

}  // namespace ayumi
