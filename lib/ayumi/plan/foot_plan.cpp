#include "ayumi/plan/foot_plan.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/place_text.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};
// Times closer than this are equal [s]. Chosen: above rounding. No measured case changes between
// half and twice the value (constants.md).
constexpr double kInstant = 1e-9;
// A foot counts as standing if its keys move it by less than this [m, rad]. Chosen: a home posture
// that is given in degrees with two decimals turns a foot by 3e-7 rad, which no author writes into
// a key; with half and with twice this bound, such a foot still stands, and moves by less than any
// tolerance of the check.
constexpr double kStands = 1e-5;

[[noreturn]] void complain(const Pattern& pattern, const std::string& place,
                           const std::string& message) {
  fail(ErrorCode::bad_pattern, in_file(pattern, place), message);
}

Isometry3d on_ground(const Vector3d& position, double yaw) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(position.x(), position.y(), 0);
  pose.linear() = rpy_to_matrix({0, 0, yaw});
  return pose;
}

// Rises from 0 to 1. The first three derivatives are zero at both ends.
double smooth_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * u * (35 + u * (-84 + u * (70 - 20 * u)));
}

double lift_profile(double u) {
  const double w = u * (1 - u);
  return 64 * w * w * w;
}

double along_ground(double u) {
  return minimum_jerk((u - kSwingMargin) / (1 - 2 * kSwingMargin)).value;
}

bool finite(const Foothold& foothold) {
  return foothold.position.allFinite() && foothold.rpy.allFinite();
}

bool same_place(const Isometry3d& a, const Isometry3d& b) {
  return (a.translation() - b.translation()).norm() < kStands &&
         (a.linear() - b.linear()).norm() < kStands;
}

// The key that moves the foot is the first key in the phase that is at another place.
[[noreturn]] void complain_of_dragged_foot(const FootPlan& feet, const Pattern& pattern, Side side,
                                           size_t phase) {
  const double first = feet.begin(static_cast<int>(phase)), until = feet.phases()[phase].until;
  const Isometry3d stands = feet.pose(side, first);
  size_t dragging = 0;
  // by_curve: no key is at another place. kept: a key at the end of the phase keeps this place.
  bool by_curve = true, kept = false;
  for (size_t i = 0; i < pattern.keyframes.size(); ++i) {
    const auto& key = pattern.keyframes[i].feet[index(side)];
    if (!key || pattern.keyframes[i].t < first - kInstant) continue;
    dragging = i;
    if (!same_place(pose_of(*key), stands)) {
      by_curve = kept;
      break;
    }
    kept = kept || std::abs(pattern.keyframes[i].t - until) < kInstant;
  }
  if (by_curve)
    complain(pattern, pointer_of_phase(pattern, phase),
             std::string("the curve between the keys of the ") + name_of(side) +
                 " foot leaves the place where this foot stands. Give these keys the interpolation "
                 "minimum_jerk, which does not overshoot");
  const double t = pattern.keyframes[dragging].t;
  const Vector3d wanted = feet.pose(side, t).translation();
  const double far = (wanted - stands.translation()).norm();
  const std::string pointer = pointer_of_keyframe(pattern, dragging);
  const std::string message =
      std::string("the ") + name_of(side) + " foot stands at " + place_text(stands.translation()) +
      " m" + " until " + text::brief(until) +
      " s, because it carries the robot, but its keys move it. The key " + pointer + " at " +
      text::brief(t) + " s " +
      (far > 1e-6
           ? "is at " + place_text(wanted) + " m" + ", " + text::brief(1000 * far, 3) + " mm away"
           : "turns the foot") +
      (t > until + kInstant
           ? ". Give the foot a key at " + text::brief(until) + " s at the place where it stands"
           : ". Give this key the place where the foot stands") +
      ", or move the foot in a phase in which it does not carry the robot";
  SourcePlace at = {pattern.file, pointer + "/feet"};
  at.names_value = true;
  const SourcePlace here = place_of_phase(pattern, phase);
  throw Error(ErrorCode::bad_pattern, text_of(here) + ": " + message, at, words_at(here, message));
}

}  // namespace

Isometry3d pose_of(const Foothold& foothold) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = foothold.position;
  pose.linear() = rpy_to_matrix(foothold.rpy);
  return pose;
}

std::array<Isometry3d, 2> start_feet(const RobotModel& model, const Pattern& pattern) {
  RobotState state = model.rest_state();
  state.theta = default_posture(model, pattern);
  RobotData data(model);
  update_positions(model, state, data);
  std::array<Isometry3d, 2> feet;
  Vector3d middle = Vector3d::Zero();
  for (const Side side : kSides) {
    const Isometry3d sole = sole_pose(model, data, side);
    feet[index(side)] = on_ground(sole.translation(), matrix_to_rpy(sole.linear()).z());
    middle += 0.5 * feet[index(side)].translation();
  }
  for (Isometry3d& foot : feet) foot.translation() -= middle;
  const auto given = pattern.start_feet;
  for (const Side side : kSides) {
    const auto& foot = given[index(side)];
    if (!foot) continue;
    if (!finite(*foot)) complain(pattern, "/start", "a number of the foothold is not finite");
    const int here = index(side), there = index(other(side));
    if (!given[there]) feet[there] = pose_of(*foot) * feet[here].inverse() * feet[there];
    feet[here] = pose_of(*foot);
  }
  return feet;
}

FootPlan::FootPlan(const RobotModel& model, const Pattern& pattern, double flight_ramp)
    : phases_(pattern.phases), flight_ramp_(flight_ramp), start_(start_feet(model, pattern)) {
  for (const Side side : kSides) {
    const Eigen::Vector2d& c = model.sole(side).center;
    center_[index(side)] = {c.x(), c.y(), 0};
  }
  read_phases(pattern);
  for (const Side side : kSides) read_foot_keys(pattern, side);
}

void FootPlan::read_phases(const Pattern& pattern) {
  if (phases_.empty())
    complain(pattern, "/phases",
             "the list is empty; give at least one phase, which says which feet carry the robot");
  std::array<Isometry3d, 2> now = start_;
  double begin = 0;
  for (size_t i = 0; i < phases_.size(); ++i) {
    Phase& phase = phases_[i];
    const std::string place = pointer_of_phase(pattern, i);
    if (!(phase.until > begin) || !std::isfinite(phase.until))
      complain(pattern, place,
               "the phase begins at " + text::exact(begin) + " s and ends at " +
                   text::exact(phase.until) + " s; give a later \"until\"");
    if (phase.swing) {
      Swing& swing = *phase.swing;
      if (supports(phase.support, swing.foot))
        complain(pattern, place,
                 std::string("the ") + name_of(swing.foot) +
                     " foot swings while it carries the "
                     "robot (support " +
                     name_of(phase.support) + "). Set \"support\" to the other foot");
      const int foot = index(swing.foot);
      const Isometry3d to = swing.step ? landing_of(swing, *swing.step, now) : pose_of(swing.to);
      if (!to.matrix().allFinite() || !std::isfinite(swing.lift) || swing.lift < 0)
        complain(pattern, place + "/swing", "a number is not finite, or the lift is below 0");
      if (swing.step) swing.to = {to.translation(), matrix_to_rpy(to.linear())};
      swing.step.reset();
      const Vector3d turn =
          log_rotation(Eigen::Quaterniond(now[foot].linear().transpose() * to.linear()));
      moves_[foot].push_back({begin, phase.until, now[foot], to, swing.lift, turn});
      now[foot] = to;
    }
    begin = phase.until;
  }
}

Isometry3d FootPlan::landing_of(const Swing& swing, const RelativeStep& step,
                                const std::array<Isometry3d, 2>& now) const {
  const int foot = index(swing.foot), stands = index(other(swing.foot));
  const Isometry3d beside = start_[stands].inverse() * start_[foot];
  Isometry3d landing = Isometry3d::Identity();
  landing.translation() = Vector3d(step.forward, beside.translation().y() + step.side, step.up);
  landing.linear() = rpy_to_matrix({0, 0, step.turn + matrix_to_rpy(beside.linear()).z()});
  return now[stands] * landing;
}

void FootPlan::read_foot_keys(const Pattern& pattern, Side side) {
  std::array<std::vector<TrackKey>, 6> keys;
  const auto add = [&](double t, const Vector3d& position, const Vector3d& rpy,
                       Interpolation interpolation) {
    for (int i = 0; i < 3; ++i) {
      keys[i].push_back({t, position[i], interpolation});
      const double last = keys[3 + i].empty() ? rpy[i] : keys[3 + i].back().value;
      keys[3 + i].push_back({t, last + std::remainder(rpy[i] - last, 2 * M_PI), interpolation});
    }
  };
  const Isometry3d& start = start_[index(side)];
  for (size_t i = 0; i < pattern.keyframes.size(); ++i) {
    const Keyframe& key = pattern.keyframes[i];
    const auto& foot = key.feet[index(side)];
    if (!foot) continue;
    const auto stop = [&](const std::string& message) {
      fail(ErrorCode::bad_pattern, place_of_keyframe(pattern, i) + "/feet", message);
    };
    if (!finite(*foot)) stop("a number of the pose of the foot is not finite");
    if (!moves_[index(side)].empty())
      stop(std::string("the ") + name_of(side) +
           " foot has keys, and it also swings in phases. Remove these keys or the swings of this "
           "foot");
    if (keys[0].empty() && key.t > 0)
      add(0, start.translation(), matrix_to_rpy(start.linear()), Interpolation::hold);
    if (!keys[0].empty() && key.t <= keys[0].back().t)
      stop("the times of the keys of this foot do not increase");
    add(key.t, foot->position, foot->rpy, key.interpolation.value_or(pattern.interpolation));
  }
  if (keys[0].empty()) return;
  KeyedFoot track;
  for (const TrackKey& key : keys[0]) track.times.push_back(key.t);
  for (int i = 0; i < 3; ++i) {
    track.position[i] = Track(keys[i]);
    track.rpy[i] = Track(keys[3 + i]);
  }
  keyed_[index(side)] = track;
  // A table with a base determines the feet itself; the check compares it with the phases.
  if (pattern.table && !pattern.table->base.empty()) return;
  for (size_t i = 0; i < phases_.size(); ++i) {
    if (!supports(phases_[i].support, side)) continue;
    const double first = begin(static_cast<int>(i)), length = phases_[i].until - first;
    for (int step = 1; step <= 8; ++step)
      if (!same_place(pose(side, first + length * step / 8), pose(side, first)))
        complain_of_dragged_foot(*this, pattern, side, i);
  }
}

const FootPlan::Move* FootPlan::move_at(Side side, double t) const {
  const std::vector<Move>& moves = moves_[index(side)];
  const auto next = std::partition_point(moves.begin(), moves.end(),
                                         [&](const Move& move) { return move.begin <= t; });
  return next == moves.begin() ? nullptr : &*std::prev(next);
}

Isometry3d FootPlan::pose(Side side, double t) const {
  Isometry3d pose = pose_without_flight(side, t);
  pose.translation().z() += flight_lift(side, t);
  return pose;
}

Isometry3d FootPlan::pose_without_flight(Side side, double t) const {
  if (const auto& keyed = keyed_[index(side)]) {
    Foothold at;
    for (int i = 0; i < 3; ++i) {
      at.position[i] = keyed->position[i].at(t).value;
      at.rpy[i] = keyed->rpy[i].at(t).value;
    }
    return pose_of(at);
  }
  const Move* move = move_at(side, t);
  if (!move) return start_[index(side)];
  if (t >= move->end) return move->to;
  const double s = along_ground((t - move->begin) / (move->end - move->begin));
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = move->from.linear() * exp_rotation(s * move->turn).toRotationMatrix();
  pose.translation() = (1 - s) * move->from.translation() + s * move->to.translation();
  pose.translation().z() += swing_lift(side, t);
  return pose;
}

double FootPlan::swing_lift(Side side, double t) const {
  const Move* move = move_at(side, t);
  if (keyed_[index(side)] || !move || t >= move->end) return 0;
  return move->lift * lift_profile((t - move->begin) / (move->end - move->begin));
}

double FootPlan::flight_lift(Side side, double t) const {
  const int i = phase(t);
  if (phases_[i].support != Support::none) return 0;
  if (phases_[i].swing && phases_[i].swing->foot == side) return 0;
  const double from = begin(i), length = phases_[i].until - from;
  if (const auto& keyed = keyed_[index(side)])
    for (const double key : keyed->times)
      if (key > from + kInstant && key < phases_[i].until - kInstant) return 0;
  const double after = std::clamp(t - from, 0.0, length), left = length - after;
  const double ramp = std::min(flight_ramp_, length / 2);
  return 0.5 * kGravity * after * left * smooth_step(after / ramp) * smooth_step(left / ramp);
}

double FootPlan::hold(Side side, double t) const {
  const Support alone = on(other(side));
  int first = phase(t), last = first;
  if (phases_[first].support != alone) return 1;
  while (first > 0 && phases_[first - 1].support == alone) --first;
  while (last + 1 < static_cast<int>(phases_.size()) && phases_[last + 1].support == alone) ++last;
  const double from = begin(first), length = phases_[last].until - from;
  return 1 - lift_profile(std::clamp((t - from) / length, 0.0, 1.0));
}

double FootPlan::ground(double t) const {
  double sum = 0;
  for (const Side side : kSides)
    sum += pose_without_flight(side, t).translation().z() - swing_lift(side, t);
  return 0.5 * sum;
}

Vector3d FootPlan::sole_center(Side side, double t) const {
  return pose(side, t) * center_[index(side)];
}

Vector3d FootPlan::support_center(double t) const {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const Side side : kSides)
    if (supports(support(t), side) || support(t) == Support::none) {
      sum += sole_center(side, t);
      ++count;
    }
  return sum / count;
}

int FootPlan::phase(double t) const {
  const auto found = std::partition_point(phases_.begin(), phases_.end(), [&](const Phase& phase) {
    return t >= phase.until - kInstant;
  });
  return static_cast<int>(
      std::min<std::ptrdiff_t>(found - phases_.begin(), static_cast<int>(phases_.size()) - 1));
}

Support FootPlan::support(double t) const { return phases_[phase(t)].support; }

}  // namespace ayumi
