// A rigid shift of all footholds to come by D moves the plan's xi now by less, because the plan's
// ZMP is still where it was: with zeta the shift of the ZMP, d xi = int omega exp(-omega s)
// zeta(t + s) ds, so D share exp(-omega T) before a landing in T. The other way round, an error of
// xi that the ZMP cannot take away until then asks for D = error exp(omega T) / share. The clock
// of the pattern shortens T. Under a clock of rate r the plan's xi runs along the same pendulum
// about the ZMP p of the single support, xi = p + (xi_landing - p) exp(-omega T / r).
#include "ayumi/control/foothold_shift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/control/support.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kKept = 0.2;          // share of the support that is kept in reserve
constexpr double kLater = 0.5;         // share of the landing foot's support that is counted on
constexpr double kReach = 0.36;        // of a foothold from the pattern's, times z
constexpr double kFootSpeed = 0.65;    // of a foot's shift, times omega z
constexpr double kLeast = 0.02;        // of what is left over, times z: less is not answered
constexpr double kAhead = 1;           // before lift-off that a foothold is chosen, times 1/omega
constexpr double kMoveCost = 0.3;      // of moving a foothold against leaving something over
constexpr double kHurryCost = 0.016;   // of the clock's rate, times z
constexpr double kRateStep = 0.1;      // between the rates tried
constexpr double kTouchShare = 0.1;    // of the weight: a foot is on the ground
constexpr double kTouchAfter = 0.3;    // of the swing: earlier forces are not a landing
constexpr double kLeastReplan = 0.03;  // a swing is not planned for less than this [s]
constexpr double kClearance = 0.008;   // between the soles' sides [m]
constexpr double kLongRest = 1.3;      // of a double support's ramp that counts, times 1/omega

ConvexPolygon about(const ConvexPolygon& polygon, const Vector2d& center) {
  std::vector<Vector2d> points;
  for (const Vector2d& p : polygon.vertices()) points.push_back(p - center);
  return ConvexPolygon(points);
}

/// What is left of an error that grows for `time` while the ZMP may be anywhere in `share` of
/// `polygon` about `zmp`.
Vector2d grown(const Vector2d& error, const ConvexPolygon& polygon, const Vector2d& zmp,
               double omega, double time, double share) {
  if (time <= 0) return error;
  const double growth = std::exp(omega * time), can = (growth - 1) * share;
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

void command_between(const CommandSeries& series, double place, CommandSample& c) {
  const std::vector<CommandSample>& s = series.samples;
  if (place >= static_cast<double>(s.size() - 1)) {
    c = s.back();
    return;
  }
  const size_t k = static_cast<size_t>(place);
  const double share = place - static_cast<double>(k);
  c = s[k];
  if (share == 0) return;
  const CommandSample& d = s[k + 1];
  mix(c.state.theta, d.state.theta, share);
  mix(c.state.dtheta, d.state.dtheta, share);
  mix(c.state.base.position, d.state.base.position, share);
  mix(c.state.base_velocity, d.state.base_velocity, share);
  mix(c.state.base_angular_velocity, d.state.base_angular_velocity, share);
  c.state.base.attitude = c.state.base.attitude.slerp(share, d.state.base.attitude);
  mix(c.cog, d.cog, share);
  mix(c.dcog, d.dcog, share);
  mix(c.ddcog, d.ddcog, share);
  mix(c.zmp, d.zmp, share);
  c.fz += share * (d.fz - c.fz);
  for (int i = 0; i < 2; ++i) {
    const Quaterniond from(c.feet[i].linear()), to(d.feet[i].linear());
    c.feet[i].linear() = from.slerp(share, to).toRotationMatrix();
    c.feet[i].translation() += share * (d.feet[i].translation() - c.feet[i].translation());
  }
}

CommandSample command_between(const CommandSeries& series, double place) {
  CommandSample c;
  command_between(series, place, c);
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
      swing_rate_(0, 0),
      swing_acceleration_(0, 0),
      data_(model) {
  const CommandSample& first = series.samples.front();
  height_ = first.cog.z() - first.zmp.z();
  omega_ = std::sqrt(kGravity / height_);
  for (const PlannedSwing& swing : swings_of(series)) steps_.push_back(step_of(swing));
  refresh();
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
  step.xi = (landed.cog + landed.dcog / omega_).head<2>();
  step.both = support_polygon(*model_, before.feet, Support::both);
  step.single = about(support_polygon(*model_, middle.feet, on(stance)), step.zmp);
  step.next = about(support_polygon(*model_, rested.feet, on(swing.foot)), rested.zmp.head<2>());
  step.stance = ground_pose(*model_, stance, landed.feet[index(stance)]);
  step.landing = ground_pose(*model_, swing.foot, landed.feet[index(swing.foot)]);
  step.share = ramp_share(std::min((swing.rest - swing.land) * series_->dt, kLongRest / omega_));
  return step;
}

/// Of a shift that the ZMP makes evenly within `time`, what xi has made of it at the start.
double FootholdShift::ramp_share(double time) const {
  return time > 0 ? (1 - std::exp(-omega_ * time)) / (omega_ * time) : 1.0;
}

/// From the foot that stood to the one that has landed, evenly over the double support.
Vector2d FootholdShift::zmp_shift() const {
  if (coming_ == 0) return after_;
  const PlannedSwing& past = steps_[coming_ - 1].swing;
  const double done = std::min(1.0, (place_ - past.land) / (past.rest - past.land));
  return before_ + done * (after_ - before_);
}

Vector2d FootholdShift::xi_shift(double rate, const Vector2d& target) const {
  Vector2d shift = zmp_shift();
  if (coming_ > 0)
    shift += ramp_share(seconds_to(steps_[coming_ - 1].swing.rest)) * (after_ - shift);
  if (coming_ == steps_.size()) return shift;
  const Step& step = steps_[coming_];
  const double time = seconds_to(step.swing.land), decay = std::exp(-omega_ * time / rate);
  shift += step.share * decay * (target - after_);
  if (rate != 1) shift += (decay - std::exp(-omega_ * time)) * (step.xi - step.zmp);
  return shift;
}

/// Of the error of xi, as it will be at the landing, what the supports cannot take away.
Vector2d FootholdShift::left_over(const Vector2d& xi, double rate) const {
  const Step& step = steps_[coming_];
  const double to_lift = seconds_to(step.swing.lift) / rate;
  const double to_land = seconds_to(step.swing.land) / rate;
  Vector2d error = xi - (now_.cog + now_.dcog / omega_).head<2>() - xi_shift(rate, after_);
  error = grown(error, step.both, now_.zmp.head<2>(), omega_, to_lift, 1 - kKept);
  error = grown(error, step.single, Vector2d::Zero(), omega_, std::min(to_land, to_land - to_lift),
                1 - kKept);
  error -= kLater * step.next.project(error / kLater);
  return error.norm() < kLeast * height_ ? Vector2d::Zero() : error;
}

/// A foot that would cross the other one stays, sideways, where the pattern has it.
Vector2d FootholdShift::not_crossing(const Vector2d& target) const {
  const Step& step = steps_[coming_];
  const Eigen::Rotation2Dd turn(step.stance.yaw);
  Vector2d way = turn.inverse() * (step.landing.position + target - after_ - step.stance.position);
  const double side = step.swing.foot == Side::left ? 1 : -1;
  if (side * way.y() < 2 * half_width_ + kClearance)
    way.y() = (turn.inverse() * (step.landing.position - step.stance.position)).y();
  return step.stance.position + turn * way - step.landing.position + after_;
}

/// What the leg can reach, and in the time that is left.
Vector2d FootholdShift::reachable(const Vector2d& target, double rate) const {
  const PlannedSwing& swing = steps_[coming_].swing;
  Vector2d way = target - after_;
  const double reach = kReach * height_;
  if (way.norm() > reach) way *= reach / way.norm();
  const double margin = kSwingMargin * (swing.land - swing.lift);
  const double begin = std::max(place_, swing.lift + margin);
  const double time = std::max(0.0, swing.land - margin - begin) * series_->dt / rate;
  const double most = kFootSpeed * omega_ * height_ * time / 1.875;  // peak of least jerk
  const Vector2d from = foot_[index(swing.foot)];
  Vector2d move = after_ + way - from;
  if (move.norm() > most) move *= most / move.norm();
  return from + move;
}

void FootholdShift::choose(const Estimate& e) {
  if (coming_ == steps_.size()) {
    rate_ = 1;
    return;
  }
  const PlannedSwing& swing = steps_[coming_].swing;
  const double weight = model_->mass() * kGravity;
  // A foot that ought to stand and does not yet is waited for: the robot leans on the other one.
  const Side stance = other(swing.foot);
  const bool stands = e.foot_fz[index(stance)] > kTouchShare * weight &&
                      (place_ < swing.lift || e.stance == stance);
  const bool early = seconds_to(swing.lift) > kAhead / omega_;
  if (!stands || early) {
    if (place_ < swing.lift) {
      rate_ = 1;
      target_ = after_;
    }
    return;
  }
  const Vector2d xi = (e.cog + e.dcog / omega_).head<2>();
  double least = std::numeric_limits<double>::infinity(), chosen = rate_;
  for (int i = 0; rate_ + i * kRateStep <= params_.hurry + 1e-9; ++i) {
    const double rate = rate_ + i * kRateStep;
    const Vector2d rest = left_over(xi, rate);
    const Vector2d wanted =
        rest.isZero(0) ? after_
                       : not_crossing(after_ + params_.share / steps_[coming_].share * rest);
    const Vector2d target = reachable(wanted, rate);
    const double cost = (wanted - target).norm() + kMoveCost * (target - after_).norm() +
                        kHurryCost * height_ * rate;
    if (cost < least) {
      least = cost;
      chosen = rate;
      target_ = target;
    }
    if (rest.isZero(0)) break;  // a faster clock leaves no less
  }
  rate_ = chosen;
  moved_ = moved_ || rate_ > 1 || target_ != after_;
}

bool FootholdShift::lands_early(const Estimate& e) const {
  if (!moved_ || coming_ == steps_.size()) return false;
  const PlannedSwing& swing = steps_[coming_].swing;
  return place_ > swing.lift + kTouchAfter * (swing.land - swing.lift) && e.stance != swing.foot &&
         e.foot_fz[index(swing.foot)] > kTouchShare * model_->mass() * kGravity;
}

/// The foot stays where it has met the ground, and the clock goes to its landing; the COG does not
/// jump.
void FootholdShift::meet(const Estimate& e) {
  const PlannedSwing& swing = steps_[coming_].swing;
  update_positions(*model_, e.state, data_);
  command_between(*series_, swing.land, work_);
  const CommandSample& landed = work_;
  const Vector3d place = sole_pose(*model_, data_, swing.foot).translation();
  foot_[index(swing.foot)] = (place - landed.feet[index(swing.foot)].translation()).head<2>();
  cog_ += (now_.cog - landed.cog).head<2>();
  land();
}

void FootholdShift::land() {
  const PlannedSwing& swing = steps_[coming_++].swing;
  place_ = swing.land;
  rate_ = 1;
  before_ = after_;
  // After the last step the ZMP ends between the feet.
  const bool last = coming_ == steps_.size();
  after_ = last ? Vector2d(0.5 * (foot_[0] + foot_[1])) : foot_[index(swing.foot)];
  target_ = after_;
  swing_rate_.setZero();
  swing_acceleration_.setZero();
}

void FootholdShift::go_on() {
  if (moved_) move_foot();
  const Vector2d rate = now_.dcog.head<2>() + omega_ * (xi_shift(rate_, target_) - cog_);
  const Vector2d cog = now_.cog.head<2>() + cog_ + series_->dt * rate;
  place_ += rate_;
  if (coming_ < steps_.size() && place_ > steps_[coming_].swing.land - 1e-6) land();
  if (!moved_) return;
  command_between(*series_, place_, work_);
  cog_ = cog - work_.cog.head<2>();
}

/// Least jerk from where the foot is to rest on the target, planned anew in every tick.
void FootholdShift::move_foot() {
  if (coming_ == steps_.size()) return;
  const PlannedSwing& swing = steps_[coming_].swing;
  const double margin = kSwingMargin * (swing.land - swing.lift);
  const double time = seconds_to(swing.land - margin) / rate_, dt = series_->dt;
  if (place_ < swing.lift + margin || time <= dt) return;
  const double t = std::max(time, kLeastReplan);
  Vector2d& at = foot_[index(swing.foot)];
  const Vector2d jerk =
      60 / (t * t * t) * (target_ - at) - 36 / (t * t) * swing_rate_ - 9 / t * swing_acceleration_;
  swing_acceleration_ += dt * jerk;
  swing_rate_ += dt * swing_acceleration_;
  at += dt * swing_rate_;
}

void FootholdShift::refresh() {
  command_between(*series_, place_, now_);
  plan_ = now_;
  if (!moved_) return;
  plan_.state.dtheta *= rate_;
  plan_.state.base_velocity *= rate_;
  plan_.state.base_angular_velocity *= rate_;
  const Vector2d zmp = zmp_shift();
  plan_.cog.head<2>() += cog_;
  plan_.dcog.head<2>() += omega_ * (xi_shift(rate_, target_) - cog_);
  plan_.ddcog.head<2>() += omega_ * omega_ * (cog_ - zmp);
  plan_.zmp.head<2>() += zmp;
  plan_.state.base.position.head<2>() += cog_;
  for (int i = 0; i < 2; ++i) plan_.feet[i].translation().head<2>() += foot_[i];
}

bool FootholdShift::advance(const Estimate& estimate) {
  choose(estimate);
  const bool early = lands_early(estimate);
  if (early)
    meet(estimate);
  else
    go_on();
  refresh();
  return early;
}

}  // namespace ayumi
