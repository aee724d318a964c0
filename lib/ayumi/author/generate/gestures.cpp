// Gestures. Each part is a minimum-jerk movement with rest at both ends. The motion starts and ends
// with the COG over the middle of the feet, or with a COG that is solved from ZMP keys.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

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

namespace {

double to_millimetre(double x) { return 1e-3 * std::round(1e3 * x); }

// Rounds an angle to a tenth of a degree. The result has the bits of an angle that is read from a
// pattern in degrees, so that it is written with one decimal.
double to_tenth_degree(double radians) {
  constexpr double degree = std::numbers::pi / 180;
  return std::round(10 * radians / degree) / 10 * degree + 0.0;
}

double rest_time(const RobotModel& model) {
  return to_hundredth_second(std::sqrt(size_beside_hoap1(model)) * kGestureRestTime);
}

Keyframe height_and_pitch(double height, double pitch) {
  Keyframe key;
  key.cog_height = to_tenth_millimetre(height);
  // Angles that were requested in tenths of a degree stay. Other angles are written to 1e-4 rad.
  const double asked = to_tenth_degree(pitch);
  const bool exact = std::abs(asked - pitch) < 1e-9;
  key.torso = Vector3d(0, exact ? asked : 1e-4 * std::round(1e4 * pitch), 0);
  return key;
}

// Distance by which the COG sinks when everything above the hips turns forward about them by
// `angle` [m].
double sinks_by_bowing(const RobotModel& model, double angle) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const int hip = model.dofs()[model.leg(Side::left).front()].body;
  double moment = 0;  // first moment of the parts above the hips about their height, divided by the
                      // robot's mass
  for (size_t b = 0; b < model.bodies().size(); ++b) {
    bool in_leg = false;
    for (int i = static_cast<int>(b); i >= 0; i = model.bodies()[static_cast<size_t>(i)].parent)
      for (const Side side : {Side::left, Side::right})
        for (const int dof : model.leg(side))
          in_leg |= model.dofs()[static_cast<size_t>(dof)].body == i;
    if (!in_leg)
      moment += model.bodies()[b].inertia.mass *
                (data.com[b].z() - data.position[static_cast<size_t>(hip)].z());
  }
  return std::max(0.0, moment / model.mass()) * (1 - elementary::cos(angle));
}

void require_seat(const char* name, const RobotModel& model, const SeatParameters& p) {
  const double leg = leg_length(model);
  require_range(name, "depth", p.depth, 0.01 * leg, 0.6 * leg, " m");
  require_range(name, "lean", p.lean * 180 / M_PI, 0, 60, " deg");
  require_range(name, "period", p.period, 0.2, 60, " s");
}

// Moves from one height to the other, and the trunk leans forward in between.
Pattern seat_pattern(const RobotModel& model, const char* name, const SeatParameters& p,
                     bool down) {
  require_seat(name, model, p);
  Pattern pattern = both_feet(model, down ? "sit down" : "rise from a seat", p.cog_height);
  const double stands = default_cog_height(model, pattern), sits = stands - p.depth;
  const double from = down ? stands : sits, to = down ? sits : stands, rest = rest_time(model);
  PatternBuilder writer{pattern};
  Keyframe first = height_and_pitch(from, 0);
  first.zmp = ZmpKey{ZmpKey::Place::center, Vector2d::Zero()};
  writer.add(0, first);
  writer.add(rest, height_and_pitch(from, 0));
  // The height has no key half-way, so that it changes in one movement.
  Keyframe middle;
  middle.torso = height_and_pitch(0, p.lean).torso;
  writer.add(rest + 0.5 * p.period, middle);
  writer.add(rest + p.period, height_and_pitch(to, 0));
  writer.phase(2 * rest + p.period, Support::both);
  return pattern;
}

}  // namespace

SeatParameters seat_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model);
  SeatParameters p;
  p.depth = to_millimetre(size * p.depth);
  p.period = to_hundredth_second(std::sqrt(size) * p.period);
  return p;
}

Pattern sit_pattern(const RobotModel& model, const SeatParameters& p) {
  return seat_pattern(model, "sit", p, true);
}

Pattern rise_pattern(const RobotModel& model, const SeatParameters& p) {
  return seat_pattern(model, "rise", p, false);
}

BowParameters bow_defaults(const RobotModel& model) {
  const double slow = std::sqrt(size_beside_hoap1(model));
  BowParameters p;
  p.period = to_hundredth_second(slow * p.period);
  p.hold = to_hundredth_second(slow * p.hold);
  return p;
}

Pattern bow_pattern(const RobotModel& model, const BowParameters& p) {
  require_range("bow", "angle", p.angle * 180 / M_PI, 1, 90, " deg");
  require_range("bow", "period", p.period, 0.2, 60, " s");
  require_range("bow", "hold", p.hold, 0, 60, " s");
  Pattern pattern = both_feet(model, "bow", p.cog_height);
  const double stands = default_cog_height(model, pattern), rest = rest_time(model);
  const double low = stands - sinks_by_bowing(model, p.angle);
  PatternBuilder writer{pattern};
  writer.key(0, ZmpKey::Place::center);
  double t = rest;
  writer.add(t, height_and_pitch(stands, 0));
  writer.add(t += p.period / 2, height_and_pitch(low, p.angle));
  if (p.hold > 0) writer.add(t += p.hold, height_and_pitch(low, p.angle));
  writer.add(t += p.period / 2, height_and_pitch(stands, 0));
  writer.phase(t + rest, Support::both);
  return pattern;
}

WaveParameters wave_defaults(const RobotModel& model) {
  WaveParameters p;
  p.period = to_hundredth_second(std::sqrt(size_beside_hoap1(model)) * p.period);
  return p;
}

Pattern wave_pattern(const RobotModel& model, const WaveParameters& p) {
  // Distance of the arm's joints from their soft limits [rad]. Chosen: the lead of the servo
  // targets needs this distance at the ends of a wave.
  constexpr double kWaveRoom = 0.05;
  require_range("wave", "cycles", p.cycles, 1, 1000, "");
  require_range("wave", "period", p.period, 0.2, 60, " s");
  Pattern pattern = both_feet(model, "wave, " + std::to_string(p.cycles) + " times", p.cog_height);
  RobotState state = model.rest_state();
  RobotData data(model);
  update_positions(model, state, data);
  const int hand = hand_body(model, p.side);
  if (hand < 0)
    fail(
        ErrorCode::usage,
        "wave: " + model.name() + " has no " + name_of(p.side) + " arm of three joints or more. " +
            (hand_body(model, other(p.side)) >= 0 ? "Choose the other hand"
                                                  : "Write keys of the joints of its arm instead"));
  const std::vector<int> arm = limb_dofs(model, hand);
  const Vector3d point = limb_point(model, hand);
  const Vector3d shoulder =
      data.position[static_cast<size_t>(model.dofs()[static_cast<size_t>(arm.back())].body)];
  double length = point.norm();
  for (int b = hand; b != model.dofs()[static_cast<size_t>(arm.back())].body;
       b = model.bodies()[static_cast<size_t>(b)].parent)
    length += model.bodies()[static_cast<size_t>(b)].placement.translation().norm();
  // The two ends of a wave, in lengths of the arm from the shoulder: ahead, outwards, up. Chosen:
  // beside the head, within reach of arms of three joints and clear of the head. If the arm cannot
  // be raised so far, the places further down the list are lower and farther ahead.
  constexpr std::array<std::array<std::array<double, 3>, 2>, 3> kPlaces = {
      {{{{0.3, 0.35, 0.65}, {0.3, 0.6, 0.5}}},
       {{{0.6, 0.3, 0.3}, {0.5, 0.6, 0.2}}},
       {{{0.65, 0.2, -0.3}, {0.5, 0.5, -0.35}}}}};
  const double out = p.side == Side::left ? 1 : -1;
  const double room = model.description().soft_limit_margin + kWaveRoom;
  std::array<Eigen::VectorXd, 2> raised;
  double missing = 0;
  for (const auto& ends : kPlaces) {
    RobotState found = state;
    double worst = 0;
    for (const size_t i : {0, 1}) {
      const Vector3d place = shoulder + length * Vector3d(ends[i][0], out * ends[i][1], ends[i][2]);
      const ReachSolution solution = reach(model, found, hand, point, place, arm, room);
      worst = std::max(worst, solution.missing);
      raised[i] = found.theta =
          solution.theta;  // the search for the other end begins near this one
    }
    missing = missing == 0 ? worst : std::min(missing, worst);
    if (worst <= 0.25 * length) break;
    raised[0].resize(0);
  }
  if (raised[0].size() == 0)
    fail(ErrorCode::usage,
         std::string("wave: the ") + name_of(p.side) + " hand stays " +
             text::fixed(1e3 * missing, 0) +
             " mm away from its places beside the head and in front of the shoulder, because "
             "joints of the arm are at their limits. Write keys of the arm's joints instead");
  const double rest = rest_time(model);
  PatternBuilder writer{pattern};
  // A joint that comes back to its limit would need a servo target beyond the limit. So an arm with
  // such a joint begins and ends beside its home posture.
  Eigen::VectorXd home = model.rest_state().theta;
  bool beside = false;
  for (const int dof : arm) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    if (!joint.limited || joint.upper - joint.lower < 2 * room) continue;
    const double inside = std::clamp(home[dof], joint.lower + room, joint.upper - room);
    if (inside == home[dof]) continue;
    home[dof] = inside;
    beside = true;
  }
  const auto at = [&](double t, const Eigen::VectorXd& theta) {
    Keyframe key;
    for (const int dof : arm) {
      const bool still =
          theta[dof] == home[dof];  // not rounded, so that the motion ends where it began
      key.joints[model.dofs()[static_cast<size_t>(dof)].name] =
          still ? theta[dof] : to_tenth_degree(theta[dof]);
    }
    writer.add(t, key);
  };
  if (beside) {
    at(0, home);
    pattern.keyframes.back().zmp = ZmpKey{ZmpKey::Place::center, Vector2d::Zero()};
  } else {
    writer.key(0, ZmpKey::Place::center);
  }
  // The arm is raised and lowered in the time of two swings.
  double t = rest;
  at(t, home);
  at(t += 2 * p.period, raised[0]);
  for (int i = 0; i < p.cycles; ++i) {
    at(t += p.period / 2, raised[1]);
    at(t += p.period / 2, raised[0]);
  }
  at(t += 2 * p.period, home);
  writer.phase(t + rest, Support::both);
  return pattern;
}

double kick_cog_height(const RobotModel& model, double height) {
  // Chosen: half of the distance by which the COG rises, so that the leg that carries the robot is
  // bent more than usual at the beginning by as much as it is bent less than usual in the kick.
  constexpr double kShare = 0.25;
  return to_millimetre(starting_height(model) - kShare * height);
}

KickParameters kick_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model);
  KickParameters p;
  p.length = to_millimetre(size * p.length);
  p.height = to_millimetre(size * p.height);
  p.period = to_hundredth_second(std::sqrt(size) * p.period);
  return p;
}

Pattern kick_pattern(const RobotModel& model, const KickParameters& p) {
  const double leg = leg_length(model);
  require_range("kick", "length", p.length, -0.5 * leg, 0.5 * leg, " m");
  require_range("kick", "height", p.height, 0.01 * leg, 0.5 * leg, " m");
  require_range("kick", "period", p.period, 0.2, 60, " s");
  Pattern pattern = both_feet(model, std::string("kick with the ") + name_of(p.side) + " foot",
                              p.cog_height != 0 ? p.cog_height : kick_cog_height(model, p.height));
  const Eigen::Isometry3d place = start_feet(model, pattern)[static_cast<size_t>(p.side)];
  const Side stands = other(p.side);
  const ZmpKey::Place under = stands == Side::left ? ZmpKey::Place::left : ZmpKey::Place::right;
  const double omega = std::sqrt(kGravity / default_cog_height(model, pattern));
  const double shift = to_hundredth_second(5 / omega), rest = rest_time(model);
  PatternBuilder writer{pattern};
  writer.key(0, ZmpKey::Place::center);
  writer.key(rest, ZmpKey::Place::center);
  writer.phase(rest + shift, Support::both);
  const auto at = [&](double share, double ahead, double up) {
    Keyframe key;
    Foothold foot;
    const Vector3d moved = place * Vector3d(ahead, 0, up);
    // Removes rounding errors of the kinematics from the place where the foot stands [m, rad].
    const auto without_rounding = [](double x) { return std::round(1e9 * x) / 1e9; };
    for (int i = 0; i < 3; ++i)
      foot.position[i] = up == 0 ? without_rounding(moved[i]) : to_tenth_millimetre(moved[i]);
    foot.rpy.z() = without_rounding(matrix_to_rpy(place.linear()).z());
    key.feet[static_cast<size_t>(p.side)] = foot;
    if (share == 0 || share == 1) key.zmp = ZmpKey{under, Vector2d::Zero()};
    writer.add(rest + shift + share * p.period, key);
  };
  at(0, 0, 0);
  at(0.35, -0.5 * p.length, 0.7 * p.height);
  at(0.6, p.length, p.height);
  at(1, 0, 0);
  writer.phase(p.period, stands == Side::left ? Support::left : Support::right);
  const double end = writer.t;
  writer.key(end + shift, ZmpKey::Place::center);
  writer.phase(shift + rest, Support::both);
  return pattern;
}

}  // namespace ayumi
