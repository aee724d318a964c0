// Footholds are relative to a centre that moves along the walk. Step i moves the centre by the
// stride along the mean heading of the step (and sideways with the leading foot) and turns it. The
// swing foot lands beside the centre at its home distance. The ZMP rests so long at both ends that
// the COG can start from rest: a bounded motion begins before the ZMP moves, by an amount that
// decreases with exp(-w t).
#include "ayumi/author/generate/generate.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/author/generate/walk_in_parts.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// These constants shape generated patterns, which the check judges afterwards.

/// Smallest accepted and default distance of a sole from the next stair [m]. Chosen: above the sink
/// and the slip that the check tolerates.
constexpr double kStairClearance = 0.002;
constexpr double kStairDefaultClearance = 0.006;
/// Half width of a stair, in leg lengths. Chosen: wider than the feet stand apart.
constexpr double kStairHalfWidth = 1;
/// Distance from hip to the lower sole, in straight leg lengths. Chosen: leaves the knee bent while
/// the other foot is on the next stair.
constexpr double kStairLeg = 0.905;

/// Time in which the ZMP rests at both ends, and time in which it then moves onto the first foot,
/// in units of 1/omega. Chosen: the motion of the COG ahead of the ZMP has fallen to exp(-4.5) = 1
/// % at the ends.
constexpr double kZmpRest = 4.5, kZmpShift = 2.6;

/// Distance by which the sole reaches forward of its frame and behind it [m].
struct SoleLength {
  double front = 0, back = 0;
};

SoleLength sole_length(const RobotModel& model) {
  SoleLength length;
  for (const Side side : {Side::left, Side::right})
    for (const Eigen::Vector2d& p : model.sole(side).polygon) {
      length.front = std::max(length.front, p.x());
      length.back = std::max(length.back, -p.x());
    }
  return length;
}

void check_stairs(const RobotModel& model, const WalkParameters& p) {
  const SoleLength sole = sole_length(model);
  if (p.turn != 0 || p.side != 0)
    fail(ErrorCode::usage, "walk: turn and side are not possible with stairs (rise)");
  require_range("walk", "rise", p.rise, 0, 0.15 * leg_length(model), " m");
  if (p.stride < sole.front + sole.back + 2 * kStairClearance)
    fail(ErrorCode::usage, "walk: stride " + text::exact(p.stride) +
                               " m is too short for stairs, because a stair must be longer than "
                               "the sole, which is " +
                               text::brief(sole.front + sole.back) + " m long. Give at least " +
                               text::brief(sole.front + sole.back + 2 * kStairClearance) + " m");
}

/// Stairs under the footholds. Each stair begins in the middle between the soles on it and the
/// soles before it.
World stairs(const RobotModel& model, const WalkParameters& p) {
  const SoleLength sole = sole_length(model);
  const double spare = 0.5 * (p.stride - sole.front - sole.back);
  World world;
  for (int i = 1; i <= p.steps; ++i) {
    GroundBlock stair;
    const double from = i * p.stride - sole.back - spare;
    stair.low = {to_tenth_millimetre(from), -kStairHalfWidth * leg_length(model)};
    stair.high = {to_tenth_millimetre(from + (i < p.steps ? p.stride : 3 * p.stride)),
                  kStairHalfWidth * leg_length(model)};
    for (Eigen::Vector2d* corner : {&stair.low, &stair.high})
      corner->y() = to_tenth_millimetre(corner->y());
    stair.height = to_tenth_millimetre(i * p.rise);
    world.blocks.push_back(stair);
  }
  return world;
}

// Smallest lift of a swing [m], if the robot is not so small that its usual lift is lower. Reason:
// with a lower lift, the foot of a robot with short legs scrapes the ground in its longest step
// (limits/foot_scrape.cpp). The longest swing of a leg of 0.2 m is 0.24 m, and it needs a lift of
// 1.9 mm. For legs of more than 0.2 m, a hundredth of the leg is more. Test:
// FootScrape.TheLowestLiftPasses.
constexpr double kLeastLift = 0.002;

void check_parameters(const RobotModel& model, const WalkParameters& p) {
  const double leg = leg_length(model);
  if (p.rise != 0) check_stairs(model, p);
  require_range("walk", "steps", p.steps, 1, 10000, "");
  require_range("walk", "stride", p.stride, -0.6 * leg, 0.6 * leg, " m");
  const WalkLimits limits = walk_limits(model);
  require_range("walk", "period", p.period, limits.period, 10, " s");
  require_range("walk", "double_support", p.double_support, 0.05, 0.6, "");
  require_range("walk", "lift", p.lift, limits.lift, 0.4 * leg, " m");
  require_range("walk", "side", p.side, -0.4 * leg, 0.4 * leg, " m");
  require_range("walk", "turn", p.turn * 180 / M_PI, -0.6 * 180 / M_PI, 0.6 * 180 / M_PI, " deg");
  require_range("walk", "zmp_inwards", p.zmp_inwards, 0, half_sole_width(model), " m");
  require_cog_height("walk", p.cog_height, leg);
}

ZmpKey::Place place_of(Side side) {
  return side == Side::left ? ZmpKey::Place::left : ZmpKey::Place::right;
}

Foothold foothold(const Vector3d& center, double yaw, double beside, int decimals) {
  double parts = 1;
  for (int i = 0; i < decimals; ++i) parts *= 10;
  const auto rounded = [&](double x) { return std::round(parts * x) / parts + 0.0; };
  const Vector3d at = center + rpy_to_matrix({0, 0, yaw}) * Vector3d(0, beside, 0);
  Foothold result;
  result.position = {rounded(at.x()), rounded(at.y()), rounded(at.z())};
  result.rpy.z() = rounded(yaw);
  return result;
}

// The ZMP under the standing foot: in the middle of its sole, or nearer to the other foot.
Keyframe stance_key(const RobotModel& model, const WalkParameters& p, Side stance,
                    const Isometry3d& foot) {
  Keyframe key;
  if (p.zmp_inwards == 0) {
    key.zmp = ZmpKey{place_of(stance), Eigen::Vector2d::Zero()};
    return key;
  }
  const Eigen::Vector2d center = model.sole(stance).center;
  const double inwards = stance == Side::left ? -p.zmp_inwards : p.zmp_inwards;
  const Vector3d at = foot * Vector3d(center.x(), center.y() + inwards, 0);
  key.zmp =
      ZmpKey{ZmpKey::Place::point, {to_tenth_millimetre(at.x()), to_tenth_millimetre(at.y())}};
  return key;
}

// The point half-way between the middle of the soles and the ZMP over one of the feet.
Keyframe half_key(const RobotModel& model, const WalkParameters& p, Side side,
                  const std::array<Isometry3d, 2>& feet) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Side each : {Side::left, Side::right}) {
    const Eigen::Vector2d center = model.sole(each).center;
    middle +=
        0.5 * (feet[static_cast<size_t>(each)] * Vector3d(center.x(), center.y(), 0)).head<2>();
  }
  const Keyframe key = stance_key(model, p, side, feet[static_cast<size_t>(side)]);
  const Eigen::Vector2d half = 0.5 * (middle + key.zmp->point);
  Keyframe result;
  result.zmp =
      ZmpKey{ZmpKey::Place::point, {to_tenth_millimetre(half.x()), to_tenth_millimetre(half.y())}};
  return result;
}

// A step without a swing: with both feet on the ground, the ZMP moves half of the distance to one
// foot and stays there for the time of a swing. The COG then sways before the first swing as it
// does in the walk, and never farther; a ZMP that goes to the first standing foot and waits there
// would draw the COG with it. This is necessary for legs that can move the COG only a few
// millimetres sideways.
void sway_in_place(PatternBuilder& writer, const Keyframe& key, const WalkParameters& p) {
  const double change = to_millisecond(p.period * p.double_support);
  writer.phase(change, Support::both);
  writer.add(writer.t, key);
  writer.phase(p.period - change, Support::both);
  writer.add(writer.t, key);
}

void write_step(PatternBuilder& writer, const RobotModel& model, const WalkParameters& p,
                Side swing_foot, const Foothold& to, std::array<Isometry3d, 2>& feet) {
  const double single = p.period * (1 - p.double_support);
  const Side stance = other(swing_foot);
  const Keyframe key = stance_key(model, p, stance, feet[static_cast<int>(stance)]);
  writer.add(writer.t, key);
  writer.phase(single, stance == Side::left ? Support::left : Support::right,
               Swing{swing_foot, to, to_tenth_millimetre(p.lift)});
  writer.add(writer.t, key);
  Isometry3d& placed = feet[static_cast<int>(swing_foot)];
  placed.linear() = rpy_to_matrix(to.rpy);
  placed.translation() = to.position;
}

std::string title(const WalkParameters& p) {
  std::string name = "walk, " + std::to_string(p.steps) +
                     (p.rise != 0 ? " stairs of " : " steps of ") + text::brief(1e3 * p.stride) +
                     " mm";
  if (p.side != 0) name += ", " + text::brief(1e3 * p.side) + " mm sideways per pair";
  if (p.rise != 0) name += ", rising " + text::brief(1e3 * p.rise) + " mm each";
  if (p.turn != 0) name += ", turning " + text::brief(p.turn * 180 / M_PI) + " deg per step";
  return name;
}

}  // namespace

double half_sole_width(const RobotModel& model) {
  double half = INFINITY;
  for (const Side side : {Side::left, Side::right}) {
    double low = INFINITY, high = -INFINITY;
    for (const Eigen::Vector2d& p : model.sole(side).polygon) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    half = std::min(half, 0.5 * (high - low));
  }
  return half;
}

double starting_height(const RobotModel& model) {
  const double bent = bent_height(model);
  return bent != 0 ? bent : default_cog_height(model, {});
}

WalkParameters walk_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model), slow = std::sqrt(size);
  WalkParameters p;
  p.stride = 1e-3 * std::round(1e3 * size * p.stride);
  p.lift = 1e-3 * std::round(1e3 * size * p.lift);
  p.period = 0.01 * std::round(100 * slow * p.period);
  return p;
}

WalkLimits walk_limits(const RobotModel& model) {
  // Legs swing as pendulums do: a robot of a quarter of HOAP-1's size can step twice as fast.
  const double fastest = 0.2 * std::min(1.0, std::sqrt(size_beside_hoap1(model)));
  return {0.01 * std::floor(100 * fastest),
          std::max(0.01 * leg_length(model), std::min(kLeastLift, walk_defaults(model).lift))};
}

WalkParameters stair_defaults(const RobotModel& model, double rise) {
  WalkParameters p = walk_defaults(model);
  const SoleLength sole = sole_length(model);
  p.rise = rise;
  p.steps = 3;
  p.stride = 1e-3 * std::ceil(1e3 * (sole.front + sole.back + 2 * kStairDefaultClearance));
  p.period = 0.05 * std::round(22 * p.period);
  p.lift = to_tenth_millimetre(rise + 0.006 * size_beside_hoap1(model));
  const double apart = 0.5 * p.stride, leg = kStairLeg * leg_length(model);
  const double wanted = std::sqrt(std::max(0.0, leg * leg - apart * apart)) - 0.5 * rise;
  p.cog_height = default_cog_height(model, {}) - std::max(0.0, home_reach(model) - wanted);
  return p;
}

Pattern walk_pattern(const RobotModel& model, const WalkParameters& parameters) {
  return walk_in_parts(model, {parameters});
}

Pattern walk_in_parts(const RobotModel& model, const std::vector<WalkParameters>& parts,
                      int decimals) {
  if (parts.empty()) fail(ErrorCode::usage, "walk: give at least one part");
  const WalkParameters& first = parts.front();
  for (const WalkParameters& p : parts) {
    check_parameters(model, p);
    if (p.cog_height != first.cog_height)
      fail(ErrorCode::usage, "walk: the COG height must be the same in all parts");
    if (p.rise != 0 && parts.size() > 1)
      fail(ErrorCode::usage, "walk: a walk of several parts cannot climb stairs (rise)");
  }
  Pattern pattern;
  for (const WalkParameters& p : parts)
    pattern.name += (pattern.name.empty() ? "" : ", then ") + title(p);
  pattern.robot = model.name();
  pattern.cog_height = to_tenth_millimetre(first.cog_height);

  if (first.cog_height == 0) pattern.cog_height = bent_height(model);

  const auto start = start_feet(model, pattern);
  auto feet = start;
  const double beside = 0.5 * (start[0].translation() - start[1].translation()).norm();
  const double omega = std::sqrt(kGravity / default_cog_height(model, pattern));
  const double rest = to_millisecond(0.01 * std::round(100 * kZmpRest / omega));
  const double shift = to_millisecond(0.01 * std::round(100 * kZmpShift / omega));

  PatternBuilder writer{pattern};
  writer.key(0, ZmpKey::Place::center);
  writer.key(rest, ZmpKey::Place::center);
  Side swing = first.first_swing;
  const bool sways = first.zmp_inwards > 0;
  if (sways) {
    writer.phase(rest, Support::both);
    sway_in_place(writer, half_key(model, first, swing, feet), first);
    writer.phase(first.period * first.double_support, Support::both);
  } else {
    writer.phase(rest + shift, Support::both);
  }
  Vector3d center = Vector3d::Zero();
  double yaw = 0;
  if (first.rise != 0) {
    pattern.world = stairs(model, first);
    // Between soles of different height, the height of the ZMP is a matter of convention.
    pattern.tolerances["zmp_residual"] = to_tenth_millimetre(std::max(0.005, 0.6 * first.rise));
  }
  for (size_t part = 0; part < parts.size(); ++part) {
    const WalkParameters& p = parts[part];
    const Side leading = p.side > 0 ? Side::left : Side::right;
    const bool last = part + 1 == parts.size();
    const int swings = p.rise != 0 ? 2 * p.steps : p.steps + last;
    for (int i = 0; i < swings; ++i) {
      const bool closing = last && i + 1 == swings;
      if (p.rise != 0) {
        if (i % 2 == 0) center += Vector3d(p.stride, 0, p.rise);
      } else if (!closing) {
        const double turned = yaw + p.turn;
        const Vector3d move(p.stride, swing == leading ? p.side : 0.0, 0);
        center += rpy_to_matrix({0, 0, 0.5 * (yaw + turned)}) * move;
        yaw = turned;
      }
      write_step(writer, model, p, swing,
                 foothold(center, yaw, swing == Side::left ? beside : -beside, decimals), feet);
      if (!closing) writer.phase(p.period * p.double_support, Support::both);
      swing = other(swing);
    }
  }
  if (sways) {
    const WalkParameters& p = parts.back();
    sway_in_place(writer, half_key(model, p, other(swing), feet), p);
    const double change = to_millisecond(p.period * p.double_support);
    writer.key(writer.t + change, ZmpKey::Place::center);
    writer.phase(rest + change, Support::both);
    return pattern;
  }
  writer.key(writer.t + shift, ZmpKey::Place::center);
  writer.phase(rest + shift, Support::both);
  return pattern;
}

Pattern stand_pattern(const RobotModel& model, double duration, double cog_height) {
  if (!(duration >= 0.01 && duration <= 3600))
    fail(ErrorCode::usage, "stand: duration " + text::exact(duration) +
                               " s is out of range. Give a value from 0.01 to 3600 s");
  Pattern pattern;
  pattern.name = "stand for " + text::brief(duration) + " s";
  pattern.robot = model.name();
  pattern.cog_height = cog_height != 0 ? to_tenth_millimetre(cog_height) : bent_height(model);
  PatternBuilder writer{pattern};
  writer.key(0, ZmpKey::Place::center);
  writer.phase(duration, Support::both);
  return pattern;
}

}  // namespace ayumi
