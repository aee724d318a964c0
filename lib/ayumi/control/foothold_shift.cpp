// If all coming footholds are shifted by D, the present DCM of the plan is shifted by less, because
// the ZMP of the plan is still at its old place. With zeta the shift of the ZMP, the shift of the
// DCM is d dcm = int omega exp(-omega s) zeta(t + s) ds, which is D share exp(-omega T) at the time
// T before a landing. Conversely, an error of the DCM that the ZMP cannot remove until then
// requires D = error exp(omega T) / share. A faster clock of the pattern shortens T. Under a clock
// of rate r the plan's DCM runs along the same pendulum about the ZMP p of the single support,
// dcm = p + (dcm_landing - p) exp(-omega T / r).
#include "ayumi/control/foothold_shift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/control/support_region.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Derivation: docs/theory.md, "Moving footholds". The effect of the footholds in 32 walking pushes
// of HOAP-1: docs/measurements/pushes.md. Lengths are multiples of the COG height z, and times are
// multiples of 1 / omega.

// Share of each support that is kept in reserve. Chosen: the robot differs from the point mass.
// Its effect is in constants.md.
constexpr double kReserve = 0.2;

// Share of the landing foot's support that is taken into account. Chosen: the ZMP only gets there
// in the course of the double support. Its effect is in constants.md.
constexpr double kNextSupportShare = 0.5;

// Largest distance of a foothold from the foothold of the pattern [z]. Chosen: within the reach of
// the legs with the COG at the height of a walk. Its effect is in constants.md.
constexpr double kFootholdReach = 0.36;

// Largest speed of a foot's shift [omega z]. Chosen: the swing itself needs the rest of the joint
// speed of HOAP-1. Its effect is in constants.md.
constexpr double kFootSpeed = 0.65;

// Smallest error at the landing to which a foothold reacts [z]: 4 mm on HOAP-1. Chosen: the sole
// absorbs smaller errors. Its effect is in constants.md.
constexpr double kLeastError = 0.02;

// A foothold is chosen from this time before lift-off on [1/omega]. Chosen: before this time, the
// present support can still remove the error. Its effect is in constants.md.
constexpr double kLookAhead = 1;

// Cost of moving a foothold by a length, relative to the cost of a remaining error of the same
// length. Chosen: a larger movement is preferred if it reduces the remaining error by at least a
// third of the additional distance. Its effect is in constants.md.
constexpr double kMoveCost = 0.3;

// Cost of the clock's rate 1 [z]. Chosen: small, so that a faster clock is chosen whenever it
// leaves a smaller error. Of two clocks that leave the same error, the slower one is chosen. Half
// or twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kTimeScaleCost = 0.016;

// Step between the rates of the clock that are tried. Chosen: 16 candidates up to 2.5. Half or
// twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kTimeScaleStep = 0.1;

// A force on the swing foot before this share of the swing is not a landing. Chosen: a foot that
// has just left the ground still drags; a tipped robot's foot may land soon after. Its effect is in
// constants.md.
constexpr double kSwingLandingAfter = 0.3;

// Longest double support over which the shift of the ZMP counts as a ramp [1/omega]. Chosen: the
// part of a ramp after this time has less than a third of its effect on the DCM. Between half and
// twice the value, figures change by less than 5 %.
constexpr double kLongestRamp = 1.3;

// Peak speed of a path of least jerk from rest to rest, in units of its mean speed. Derived: 15/8,
// the derivative of 10 s^3 - 15 s^4 + 6 s^5 at s = 1/2.
constexpr double kLeastJerkPeak = 1.875;

ConvexPolygon about_zmp(const ConvexPolygon& polygon, const Vector2d& center) {
  std::vector<Vector2d> points;
  for (const Vector2d& p : polygon.vertices()) points.push_back(p - center);
  return ConvexPolygon(points);
}

/// The part of an error that remains. The error grows during `time`, while the ZMP may be anywhere
/// in a part `share` of `polygon` about `zmp`.
Vector2d error_after(const Vector2d& error, const ConvexPolygon& polygon, const Vector2d& zmp,
                     double omega, double time, double share) {
  if (time <= 0) return error;
  const double growth = elementary::exp(omega * time), can = (growth - 1) * share;
  const Vector2d wanted = error * growth / can;
  return can * (wanted - (polygon.project(wanted + zmp) - zmp));
}

template <typename T>
void mix(T& a, const T& b, double share) {
  a += share * (b - a);
}

}  // namespace

std::vector<PlannedSwing> swings_of(const CommandSeries& series) {
  const std::vector<CommandSample>& s = series.samples;
  std::vector<PlannedSwing> swings;
  for (size_t k = 1; k < s.size(); ++k) {
    const Support before = s[k - 1].support;
    if (s[k].support != Support::both || (before != Support::left && before != Support::right))
      continue;
    size_t lift = k - 1, rest = k;
    while (lift > 0 && s[lift - 1].support == before) --lift;
    while (rest + 1 < s.size() && s[rest].support == Support::both) ++rest;
    swings.push_back({static_cast<double>(lift), static_cast<double>(k), static_cast<double>(rest),
                      before == Support::left ? Side::right : Side::left});
  }
  return swings;
}

void command_between(const CommandSeries& series, double phase, CommandSample& c) {
  const std::vector<CommandSample>& s = series.samples;
  if (phase >= static_cast<double>(s.size() - 1)) {
    c = s.back();
    if (phase > static_cast<double>(s.size() - 1) && c.support != Support::none) rest_plan(c);
    return;
  }
  const size_t k = static_cast<size_t>(phase);
  const double share = phase - static_cast<double>(k);
  c = s[k];
  if (share == 0) return;
  const CommandSample& d = s[k + 1];
  mix(c.state.theta, d.state.theta, share);
  mix(c.state.dtheta, d.state.dtheta, share);
  mix(c.state.base.position, d.state.base.position, share);
  mix(c.state.base_velocity, d.state.base_velocity, share);
  mix(c.state.base_angular_velocity, d.state.base_angular_velocity, share);
  c.state.base.attitude = elementary::between(c.state.base.attitude, d.state.base.attitude, share);
  mix(c.cog, d.cog, share);
  mix(c.dcog, d.dcog, share);
  mix(c.ddcog, d.ddcog, share);
  mix(c.zmp, d.zmp, share);
  c.fz += share * (d.fz - c.fz);
  for (int i = 0; i < 2; ++i) {
    const Quaterniond from(c.feet[i].linear()), to(d.feet[i].linear());
    c.feet[i].linear() = elementary::between(from, to, share).toRotationMatrix();
    c.feet[i].translation() += share * (d.feet[i].translation() - c.feet[i].translation());
  }
}

CommandSample command_between(const CommandSeries& series, double phase) {
  CommandSample c;
  command_between(series, phase, c);
  return c;
}

FootholdShift::FootholdShift(const RobotModel& model, const CommandSeries& series,
                             const FootholdParams& params)
    : model_(&model),
      series_(&series),
      params_(params),
      half_width_(sole_half_width(model)),
      foot_{Vector2d::Zero(), Vector2d::Zero()},
      before_(0, 0),
      after_(0, 0),
      target_(0, 0),
      cog_(0, 0),
      data_(model) {
  const CommandSample& first = series.samples.front();
  height_ = first.cog.z() - first.zmp.z();
  omega_ = std::sqrt(kGravity / height_);
  for (const PlannedSwing& swing : swings_of(series)) steps_.push_back(step_of(swing));
  update_plan();
}

FootholdShift::Step FootholdShift::step_of(const PlannedSwing& swing) const {
  Step step;
  step.swing = swing;
  const Side stance = other(swing.foot);
  const CommandSample middle = command_between(*series_, 0.5 * (swing.lift + swing.land));
  const CommandSample landed = command_between(*series_, swing.land);
  const CommandSample rested = command_between(*series_, swing.rest);
  const CommandSample& before =
      series_->samples[static_cast<size_t>(std::max(swing.lift - 1, 0.0))];
  step.zmp = middle.zmp.head<2>();
  step.dcm = divergent_component(landed.cog, landed.dcog, omega_).head<2>();
  step.before = support_polygon(*model_, before.feet, Support::both);
  step.single = about_zmp(support_polygon(*model_, middle.feet, on(stance)), step.zmp);
  step.next =
      about_zmp(support_polygon(*model_, rested.feet, on(swing.foot)), rested.zmp.head<2>());
  step.stance = ground_pose(*model_, stance, landed.feet[index(stance)]);
  step.landing = ground_pose(*model_, swing.foot, landed.feet[index(swing.foot)]);
  step.share = ramp_share(std::min((swing.rest - swing.land) * series_->dt, kLongestRamp / omega_));
  return step;
}

/// The share of a shift of the ZMP that the DCM must already have made when the shift begins. The
/// ZMP makes the shift evenly within `time`.
double FootholdShift::ramp_share(double time) const {
  return time > 0 ? (1 - elementary::exp(-omega_ * time)) / (omega_ * time) : 1.0;
}

/// Moves the ZMP from the foot that stood to the foot that has landed, evenly over the double
/// support.
Vector2d FootholdShift::zmp_shift() const {
  if (coming_ == 0) return after_;
  const PlannedSwing& past = steps_[coming_ - 1].swing;
  const double done = std::min(1.0, (phase_ - past.land) / (past.rest - past.land));
  return before_ + done * (after_ - before_);
}

Vector2d FootholdShift::dcm_shift(double time_scale, const Vector2d& target) const {
  Vector2d shift = zmp_shift();
  if (coming_ > 0)
    shift += ramp_share(seconds_to(steps_[coming_ - 1].swing.rest)) * (after_ - shift);
  if (coming_ == steps_.size()) return shift;
  const Step& step = steps_[coming_];
  const double time = seconds_to(step.swing.land),
               decay = elementary::exp(-omega_ * time / time_scale);
  shift += step.share * decay * (target - after_);
  if (time_scale != 1) shift += (decay - elementary::exp(-omega_ * time)) * (step.dcm - step.zmp);
  return shift;
}

/// The part of the DCM's error at the landing that the supports cannot remove.
Vector2d FootholdShift::error_left_over(const Vector2d& dcm, double time_scale) const {
  const Step& step = steps_[coming_];
  const double to_lift = seconds_to(step.swing.lift) / time_scale;
  const double to_land = seconds_to(step.swing.land) / time_scale;
  Vector2d error = dcm - divergent_component(now_.cog, now_.dcog, omega_).head<2>() -
                   dcm_shift(time_scale, after_);
  error = error_after(error, step.before, now_.zmp.head<2>(), omega_, to_lift, 1 - kReserve);
  error = error_after(error, step.single, Vector2d::Zero(), omega_,
                      std::min(to_land, to_land - to_lift), 1 - kReserve);
  error -= kNextSupportShare * step.next.project(error / kNextSupportShare);
  return error.norm() < kLeastError * height_ ? Vector2d::Zero() : error;
}

/// A foot that would cross the other one keeps the sideways place of the pattern.
Vector2d FootholdShift::not_crossing(const Vector2d& target) const {
  const Step& step = steps_[coming_];
  const Eigen::Matrix2d turn = elementary::turn_in_plane(step.stance.yaw);
  Vector2d offset =
      turn.transpose() * (step.landing.position + target - after_ - step.stance.position);
  const double side = step.swing.foot == Side::left ? 1 : -1;
  if (side * offset.y() < 2 * half_width_ + kSoleClearance)
    offset.y() = (turn.transpose() * (step.landing.position - step.stance.position)).y();
  return step.stance.position + turn * offset - step.landing.position + after_;
}

/// Distance by which the foot can be moved in the remaining time [m].
double FootholdShift::swing_room(double time_scale) const {
  const PlannedSwing& swing = steps_[coming_].swing;
  const double margin = kSwingMargin * (swing.land - swing.lift);
  const double begin = std::max(phase_, swing.lift + margin);
  const double time = std::max(0.0, swing.land - margin - begin) * series_->dt / time_scale;
  return kFootSpeed * omega_ * height_ * time / kLeastJerkPeak;
}

/// Limits a shift to the reach of the leg and to the remaining time.
Vector2d FootholdShift::reachable(const Vector2d& target, double time_scale) const {
  Vector2d shift = target - after_;
  const double reach = kFootholdReach * height_;
  if (shift.norm() > reach) shift *= reach / shift.norm();
  const double most = swing_room(time_scale);
  const Vector2d from = foot_[index(steps_[coming_].swing.foot)];
  Vector2d move = after_ + shift - from;
  if (move.norm() > most) move *= most / move.norm();
  return from + move;
}

void FootholdShift::choose_foothold(const Estimate& e) {
  if (coming_ == steps_.size()) {
    time_scale_ = 1;
    return;
  }
  const PlannedSwing& swing = steps_[coming_].swing;
  // The clock waits for a foot that should stand but does not stand yet: the robot leans on the
  // other foot.
  const Side stance = other(swing.foot);
  const bool stands = bears(*model_, e, stance) && (phase_ < swing.lift || e.stance == stance);
  const bool early = seconds_to(swing.lift) > kLookAhead / omega_;
  if (!stands || early) {
    if (phase_ < swing.lift) {
      time_scale_ = 1;
      target_ = after_;
    }
    return;
  }
  const Vector2d dcm = divergent_component(e.cog, e.dcog, omega_).head<2>();
  if (params_.program)
    solve_foothold(dcm);
  else
    search_foothold(dcm);
  moved_ = moved_ || time_scale_ != 1 || target_ != after_;
}

void FootholdShift::solve_foothold(const Vector2d& dcm) {
  const Step& step = steps_[coming_];
  const double time = seconds_to(step.swing.land);
  if (time < series_->dt) return;
  const double yaw = step.stance.yaw;
  const Eigen::Matrix2d turn = elementary::turn_in_plane(yaw);
  const auto local = [&](const Vector2d& v) -> Vector2d { return turn.transpose() * v / height_; };
  StepProblem p;
  p.error = local(dcm - divergent_component(now_.cog, now_.dcog, omega_).head<2>() -
                  dcm_shift(1, after_));
  p.dcm = local(step.dcm - step.zmp);
  p.growth = elementary::exp(omega_ * time);
  p.share = step.share;
  p.least_growth = elementary::exp(omega_ * time / params_.time_scale_limit);
  p.most_growth = elementary::exp(omega_ * time / params_.program->slowest);
  set_support(p, step.single, yaw, height_, 1 - kReserve);

  // Keeps a shift within the reach and the speed of the swing, and the foot on its own side.
  const int side = index(step.swing.foot);
  const Vector2d from = local(foot_[side] - after_);
  const Vector2d room = Vector2d::Constant(swing_room(time_scale_) / height_);
  const Vector2d reach = Vector2d::Constant(kFootholdReach);
  p.low = (from - room).cwiseMax(-reach);
  p.high = (from + room).cwiseMin(reach);
  const double apart = local(step.landing.position - step.stance.position).y();
  const double least = std::min((2 * half_width_ + kSoleClearance) / height_, std::abs(apart));
  if (step.swing.foot == Side::left)
    p.low.y() = std::max(p.low.y(), least - apart);
  else
    p.high.y() = std::min(p.high.y(), -least - apart);
  for (int axis = 0; axis < 2; ++axis)
    if (p.low[axis] > p.high[axis])
      p.low[axis] = p.high[axis] = std::clamp(from[axis], p.high[axis], p.low[axis]);

  const StepChoice choice = choose_step(p, *params_.program);
  const double left = elementary::log(choice.growth) / omega_;
  time_scale_ = left > series_->dt
                    ? std::clamp(time / left, params_.program->slowest, params_.time_scale_limit)
                    : params_.time_scale_limit;
  target_ = reachable(after_ + height_ * (turn * choice.move), time_scale_);
}

void FootholdShift::search_foothold(const Vector2d& dcm) {
  double least = std::numeric_limits<double>::infinity(), chosen = time_scale_;
  for (int i = 0; time_scale_ + i * kTimeScaleStep <= params_.time_scale_limit + 1e-9; ++i) {
    const double time_scale = time_scale_ + i * kTimeScaleStep;
    const Vector2d rest = error_left_over(dcm, time_scale);
    const Vector2d wanted =
        rest.isZero(0) ? after_
                       : not_crossing(after_ + params_.share / steps_[coming_].share * rest);
    const Vector2d target = reachable(wanted, time_scale);
    const double cost = (wanted - target).norm() + kMoveCost * (target - after_).norm() +
                        kTimeScaleCost * height_ * time_scale;
    if (cost < least) {
      least = cost;
      chosen = time_scale;
      target_ = target;
    }
    if (rest.isZero(0)) break;  // a faster clock leaves an error that is at least as large
  }
  time_scale_ = chosen;
}

// In the last part of the swing, the planned foot is next to the ground and hardly moves. A contact
// in this part is the planned landing, so the clock is not advanced to the landing. Such a step of
// the clock would also move the DCM of the plan.
bool FootholdShift::lands_early(const Estimate& e) const {
  if (!moved_ || coming_ == steps_.size()) return false;
  const PlannedSwing& swing = steps_[coming_].swing;
  const double length = swing.land - swing.lift;
  return phase_ > swing.lift + kSwingLandingAfter * length &&
         phase_ < swing.land - kSwingMargin * length && e.stance != swing.foot &&
         bears(*model_, e, swing.foot);
}

/// The foot stays where it has met the ground, and the clock is advanced to its landing at once.
/// The COG does not change suddenly.
void FootholdShift::land_where_it_is(const Estimate& e) {
  const PlannedSwing& swing = steps_[coming_].swing;
  update_positions(*model_, e.state, data_);
  command_between(*series_, swing.land, work_);
  const CommandSample& landed = work_;
  const Vector3d position = sole_pose(*model_, data_, swing.foot).translation();
  foot_[index(swing.foot)] = (position - landed.feet[index(swing.foot)].translation()).head<2>();
  cog_ += (now_.cog - landed.cog).head<2>();
  land();
}

void FootholdShift::land() {
  const PlannedSwing& swing = steps_[coming_++].swing;
  phase_ = swing.land;
  time_scale_ = 1;
  before_ = after_;
  // After the last step the ZMP ends between the feet.
  const bool last = coming_ == steps_.size();
  after_ = last ? Vector2d(0.5 * (foot_[0] + foot_[1])) : foot_[index(swing.foot)];
  target_ = after_;
  swing_.stop();
}

void FootholdShift::go_on() {
  if (moved_) move_swing_foot();
  const Vector2d rate = now_.dcog.head<2>() + omega_ * (dcm_shift(time_scale_, target_) - cog_);
  const Vector2d cog = now_.cog.head<2>() + cog_ + series_->dt * rate;
  phase_ += time_scale_;
  if (coming_ < steps_.size() && phase_ > steps_[coming_].swing.land - 1e-6) land();
  if (!moved_) return;
  command_between(*series_, phase_, work_);
  cog_ = cog - work_.cog.head<2>();
}

void FootholdShift::move_swing_foot() {
  if (coming_ == steps_.size()) return;
  const PlannedSwing& swing = steps_[coming_].swing;
  const double margin = kSwingMargin * (swing.land - swing.lift);
  const double time = seconds_to(swing.land - margin) / time_scale_, dt = series_->dt;
  if (phase_ < swing.lift + margin || time <= dt) return;
  Vector2d& at = foot_[index(swing.foot)];
  at += swing_.step(target_ - at, time, dt);
}

void FootholdShift::update_plan() {
  command_between(*series_, phase_, now_);
  plan_ = now_;
  if (!moved_) return;
  const Vector2d zmp = zmp_shift();
  PlanShift shift;
  shift.time_scale = time_scale_;
  shift.cog.head<2>() = shift.base.head<2>() = cog_;
  shift.dcog.head<2>() = omega_ * (dcm_shift(time_scale_, target_) - cog_);
  shift.ddcog.head<2>() = omega_ * omega_ * (cog_ - zmp);
  shift.zmp = zmp;
  for (size_t i = 0; i < 2; ++i) shift.foot[i].head<2>() = foot_[i];
  shift_plan(shift, plan_);
}

bool FootholdShift::advance(const Estimate& estimate) {
  choose_foothold(estimate);
  const bool early = lands_early(estimate);
  if (early)
    land_where_it_is(estimate);
  else
    go_on();
  update_plan();
  return early;
}

}  // namespace ayumi
