// One pass over the samples in order of time: inverse dynamics gives what the motion needs from the
// ground, residuals.hpp tells it against command, support, feet and motors; then the quantities
// that look at several samples (servo step, landing, RMS torque, self-collision).
#include "ayumi/check/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/check/collision_scan.hpp"
#include "ayumi/check/contacts.hpp"
#include "ayumi/check/finding_windows.hpp"
#include "ayumi/check/hints.hpp"
#include "ayumi/check/residuals.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kWindowGap = 0.020;    // violations nearer than this are one finding [s]
constexpr double kRefineBelow = 0.010;  // clearance that is worth every sample [m]
constexpr double kRounding = 1e-7;      // of lengths that are met exactly [m]

int largest_axis(const Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

void raise_to(double& maximum, double value) { maximum = std::max(maximum, value); }

class Checker {
 public:
  Checker(const RobotModel& model, const CommandSeries& series, const CheckOptions& options)
      : model_(model),
        series_(series),
        tolerance_(tolerances(options)),
        friction_(options.friction),
        limits_(model.limits(options.profile)),
        plan_(contact_plan(series)),
        collisions_(model),
        data_(model),
        weight_(model.mass() * kGravity),
        windows_(static_cast<int>(std::lround(kWindowGap / series.dt))) {
    summary_.min_zmp_margin = std::numeric_limits<double>::infinity();
    summary_.min_self_clearance = std::numeric_limits<double>::infinity();
    const int n = model.dof_count();
    square_sum_.setZero(n, series.samples.size() + 1);
  }

  ConsistencyReport run() {
    for (int k = 0; k < count(); ++k) check_sample(k);
    check_servo_steps();
    check_continuous_torque();
    check_self_collision();
    return report();
  }

 private:
  int count() const { return static_cast<int>(series_.samples.size()); }
  double tolerance(Kind kind) const { return tolerance_[static_cast<int>(kind)]; }

  void add(Kind kind, int item, int sample, double value, double limit, double excess,
           int detail = 0, Severity severity = Severity::error) {
    windows_.add({kind, item, sample, severity, value, limit, excess, detail});
  }

  void check_sample(int k) {
    const CommandSample& s = series_.samples[k];
    const VectorXd force = inverse_dynamics(model_, s.state, s.acceleration, data_);
    const Vector6d wrench = force.head<6>();
    update_plane(k);
    const GroundUse use =
        ground_use(plane_, plane_wrench(plane_, s.state.base.position, wrench), 0.02 * weight_);
    const Vector3d ddcog = wrench.head<3>() / model_.mass() - Vector3d(0, 0, kGravity);
    check_command(k, s, wrench, ddcog, use);
    if (plane_.empty())
      check_flight(k, s, wrench, ddcog);
    else
      check_ground(k, s, use);
    check_feet(k);
    check_joints(k, s);
    const auto foot =
        foot_wrenches(model_, s.support, soles_, plane_, use, s.state.base.position, wrench);
    check_torques(k, motor_torques(model_, s.state, s.acceleration, force, foot, data_));
  }

  // The support changes only where a contact interval does.
  void update_plane(int k) {
    const std::array<int, 2> now = {plan_.index[0][k], plan_.index[1][k]};
    if (now == plane_of_) return;
    plane_of_ = now;
    for (Side side : {Side::left, Side::right})
      soles_[static_cast<int>(side)] = plan_.at(side, k).sole;
    plane_ = support_plane(model_, series_.samples[k].support, soles_);
  }

  void check_vector(Kind kind, int k, const Vector3d& residual, double& maximum,
                    Severity severity = Severity::error) {
    const double size = residual.norm();
    raise_to(maximum, size);
    const double limit = tolerance(kind);
    if (size > limit) add(kind, 0, k, size, limit, size, largest_axis(residual), severity);
  }

  void check_command(int k, const CommandSample& s, const Vector6d& wrench, const Vector3d& ddcog,
                     const GroundUse& use) {
    check_vector(Kind::cog_residual, k, data_.cog - s.cog, summary_.max_cog_residual);
    const double fz_residual = wrench[2] - s.fz;
    raise_to(summary_.max_fz_residual, std::abs(fz_residual));
    const double fz_limit = tolerance(Kind::fz_residual) * weight_;
    if (std::abs(fz_residual) > fz_limit)
      add(Kind::fz_residual, 0, k, fz_residual, fz_limit, std::abs(fz_residual));
    if (plane_.empty() || !use.has_zmp) return;
    check_vector(Kind::zmp_residual, k, use.zmp_world - s.zmp, summary_.max_zmp_residual);
    const Vector3d point_mass = pendulum_zmp(data_.cog, ddcog, s.zmp.z());
    check_vector(Kind::point_mass_gap, k, point_mass - s.zmp, summary_.max_point_mass_gap,
                 Severity::info);
  }

  void check_margin(int k, int whose, double margin, Support support) {
    const double wanted = tolerance(Kind::support_margin);
    if (margin >= wanted - kRounding) return;
    const bool outside = margin < -kRounding;
    add(Kind::support_margin, whose, k, margin, outside ? 0 : wanted, -margin,
        static_cast<int>(support), outside ? Severity::error : Severity::warning);
  }

  void check_ground(int k, const CommandSample& s, const GroundUse& use) {
    const int support = static_cast<int>(s.support);
    const double least = tolerance(Kind::unilateral) * weight_;
    if (use.normal_force < least) {
      const bool pulls = use.normal_force < 0;
      add(Kind::unilateral, 0, k, use.normal_force, pulls ? 0 : least, -use.normal_force, support,
          pulls ? Severity::error : Severity::warning);
    }
    if (!use.has_zmp) return;
    summary_.min_zmp_margin = std::min(summary_.min_zmp_margin, use.margin);
    check_margin(k, 0, use.margin, s.support);
    const Vector3d cmd_zmp = plane_.frame.inverse() * s.zmp;
    const double cmd_margin = plane_.polygon.margin(cmd_zmp.head<2>());
    // The commanded ZMP tells something of its own only where the motion's ZMP is another one.
    if ((use.zmp_world - s.zmp).norm() > tolerance(Kind::zmp_residual) && cmd_margin < -kRounding)
      check_margin(k, 1, cmd_margin, s.support);

    const double grip = friction_ * use.normal_force;
    const double ratio = use.tangential_force / grip;
    raise_to(summary_.max_friction_ratio, ratio);
    const double most = tolerance(Kind::friction);
    if (ratio > most) add(Kind::friction, 0, k, ratio, most, ratio, support);
    // Nothing resists turning where the foot slides anyway, and a ZMP outside has no lever: both
    // are told above.
    if (ratio >= 1 || use.margin <= tolerance(Kind::support_margin)) return;
    const double yaw = std::abs(use.yaw_moment) / (grip * yaw_lever(plane_.polygon, use.zmp));
    raise_to(summary_.max_yaw_ratio, yaw);
    const double most_yaw = tolerance(Kind::yaw_moment);
    if (yaw > most_yaw) add(Kind::yaw_moment, 0, k, yaw, most_yaw, yaw, support);
  }

  void check_flight(int k, const CommandSample& s, const Vector6d& wrench, const Vector3d& ddcog) {
    check_vector(Kind::ballistic, k, ddcog + Vector3d(0, 0, kGravity),
                 summary_.max_ballistic_residual);
    const Vector3d about_cog =
        wrench.tail<3>() + (s.state.base.position - data_.cog).cross(Vector3d(wrench.head<3>()));
    check_vector(Kind::angular_momentum, k, about_cog, summary_.max_momentum_rate);
  }

  // The ground below a swinging foot: the lower of where it stood and where it will stand.
  double swing_depth(Side side, int k, const Isometry3d& sole) const {
    const int s = static_cast<int>(side);
    const int i = plan_.index[s][k];
    double depth = std::numeric_limits<double>::infinity();
    for (int j : {i - 1, i + 1}) {
      if (j < 0 || j >= static_cast<int>(plan_.intervals[s].size())) continue;
      const SoleError e = sole_error(model_.sole(side), sole, plan_.intervals[s][j].sole);
      depth = std::min(depth, e.penetration);
    }
    return std::isfinite(depth) ? depth : 0;
  }

  void check_feet(int k) {
    for (Side side : {Side::left, Side::right}) {
      const int foot = static_cast<int>(side);
      const ContactInterval& interval = plan_.at(side, k);
      const Isometry3d sole = sole_pose(model_, data_, side);
      double depth = 0;
      if (interval.contact) {
        const SoleError e = sole_error(model_.sole(side), sole, interval.sole);
        depth = e.penetration;
        raise_to(summary_.max_foot_float, e.gap);
        const double high = tolerance(Kind::foot_float);
        const double far = tolerance(Kind::foot_slip);
        if (e.gap > high) add(Kind::foot_float, foot, k, e.gap, high, e.gap);
        // A foot in the air does not slip: it floats.
        if (e.lowest <= high) raise_to(summary_.max_foot_slip, e.slip);
        if (e.lowest <= high && e.slip > far) add(Kind::foot_slip, foot, k, e.slip, far, e.slip);
        if (k == interval.first && k > 0) check_landing(k, side, interval.sole, sole);
      } else {
        depth = swing_depth(side, k, sole);
      }
      raise_to(summary_.max_foot_penetration, depth);
      const double deep = tolerance(Kind::foot_penetration);
      if (depth > deep) add(Kind::foot_penetration, foot, k, depth, deep, depth);
    }
  }

  // By the sample before contact: at the first one in contact the plan already stands still.
  void check_landing(int k, Side side, const Isometry3d& ground, const Isometry3d& sole) {
    RobotData before(model_);
    update_positions(model_, series_.samples[k - 1].state, before);
    const Vector3d way = sole.translation() - sole_pose(model_, before, side).translation();
    const double speed = -ground.linear().col(2).dot(way) / series_.dt;
    raise_to(summary_.max_landing_speed, speed);
    const double limit = tolerance(Kind::landing_speed);
    if (speed > limit)
      add(Kind::landing_speed, static_cast<int>(side), k, speed, limit, speed, 0,
          Severity::warning);
  }

  void check_joints(int k, const CommandSample& s) {
    const double margin = model_.description().soft_limit_margin;
    for (int i = 0; i < model_.dof_count(); ++i) {
      const Dof& dof = model_.dofs()[i];
      const double theta = s.state.theta[i], speed = s.state.dtheta[i];
      const double acceleration = std::abs(s.acceleration[6 + i]);
      if (dof.limited) {
        const double lower = dof.lower + margin, upper = dof.upper - margin;
        const double half = 0.5 * (upper - lower);
        raise_to(summary_.max_joint_position_ratio,
                 std::abs(theta - 0.5 * (lower + upper)) / std::max(half, 1e-9));
        const double beyond = std::max(lower - theta, theta - upper);
        if (beyond > tolerance(Kind::joint_position))
          add(Kind::joint_position, i, k, theta, theta > upper ? upper : lower, beyond);
      }
      if (std::isfinite(limits_.speed[i])) {
        const double ratio = std::abs(speed) / limits_.speed[i];
        raise_to(summary_.max_joint_speed_ratio, ratio);
        const double most = tolerance(Kind::joint_speed);
        if (ratio > most) add(Kind::joint_speed, i, k, speed, most * limits_.speed[i], ratio);
      }
      raise_to(summary_.max_joint_acceleration, acceleration);
      const double rough = tolerance(Kind::joint_acceleration);
      if (acceleration > rough)
        add(Kind::joint_acceleration, i, k, s.acceleration[6 + i], rough, acceleration, 0,
            Severity::warning);
    }
  }

  void check_torques(int k, const VectorXd& torque) {
    for (int i = 0; i < model_.dof_count(); ++i) {
      square_sum_(i, k + 1) = square_sum_(i, k) + torque[i] * torque[i];
      if (!std::isfinite(limits_.peak_torque[i])) continue;
      const double ratio = std::abs(torque[i]) / limits_.peak_torque[i];
      raise_to(summary_.max_torque_ratio, ratio);
      const double most = tolerance(Kind::joint_torque);
      if (ratio > most)
        add(Kind::joint_torque, i, k, torque[i], most * limits_.peak_torque[i], ratio);
    }
  }

  // Only where the planned speed does not already say so: a step between two samples.
  void check_servo_steps() {
    const double period = model_.description().servo_period;
    const int ticks = std::max(1, static_cast<int>(std::lround(period / series_.dt)));
    for (int k = ticks; k < count(); ++k) {
      const RobotState &from = series_.samples[k - ticks].state, &to = series_.samples[k].state;
      for (int i = 0; i < model_.dof_count(); ++i) {
        const double allowed = limits_.speed[i] * ticks * series_.dt;
        if (!std::isfinite(allowed)) continue;
        const double step = to.theta[i] - from.theta[i];
        const double ratio = std::abs(step) / allowed;
        raise_to(summary_.max_servo_step, ratio);
        const double planned = std::max(std::abs(from.dtheta[i]), std::abs(to.dtheta[i]));
        // Half a percent: the mean speed of a tick is not the speed at its ends.
        if (ratio > 1.005 * tolerance(Kind::servo_step) && planned <= limits_.speed[i])
          add(Kind::servo_step, i, k, step, tolerance(Kind::servo_step) * allowed, ratio);
      }
    }
  }

  void check_continuous_torque() {
    const int whole = static_cast<int>(std::lround(limits_.thermal_window / series_.dt));
    const int window = std::clamp(whole, 1, count());
    const Severity severity = count() >= whole ? Severity::error : Severity::warning;
    for (int i = 0; i < model_.dof_count(); ++i) {
      const double limit = limits_.continuous_torque[i];
      if (!std::isfinite(limit)) continue;
      for (int end = window; end <= count(); ++end) {
        const double mean = (square_sum_(i, end) - square_sum_(i, end - window)) / window;
        const double rms = std::sqrt(std::max(0.0, mean));
        raise_to(summary_.max_continuous_torque_ratio, rms / limit);
        const double most = tolerance(Kind::continuous_torque);
        if (rms > most * limit)
          add(Kind::continuous_torque, i, end - 1, rms, most * limit, rms / limit, 0, severity);
      }
    }
  }

  void note_clearance(int pair, int k, double clearance) {
    summary_.min_self_clearance = std::min(summary_.min_self_clearance, clearance);
    const double wanted = tolerance(Kind::self_collision);
    if (clearance < wanted)
      add(Kind::self_collision, pair, k, clearance, clearance < 0 ? 0 : wanted, -clearance, 0,
          clearance < 0 ? Severity::error : Severity::warning);
  }

  void check_self_collision() {
    const double near = tolerance(Kind::self_collision) + kRefineBelow;
    scan_clearance(model_, series_, collisions_, near, [this](int pair, int k, double clearance) {
      note_clearance(pair, k, clearance);
    });
  }

  ConsistencyReport report() {
    ConsistencyReport report;
    report.profile = limits_.name;
    report.consistent = true;
    if (!std::isfinite(summary_.min_zmp_margin)) summary_.min_zmp_margin = 0;
    if (!std::isfinite(summary_.min_self_clearance)) summary_.min_self_clearance = 0;
    report.summary = summary_;
    for (const FindingWindow& window : windows_.finish()) {
      const Violation& v = window.worst;
      Finding f;
      f.kind = finding_kinds()[static_cast<int>(v.kind)].kind;
      f.severity = v.severity;
      f.begin = window.first * series_.dt;
      f.end = window.last * series_.dt;
      f.at = v.sample * series_.dt;
      f.worst = v.value;
      f.limit = v.limit;
      f.unit = unit_of(v);
      f.where = where_text(model_, collisions_.pairs(), v);
      f.hint = hint_text(model_, window, series_.dt, friction_);
      if (v.severity == Severity::error) report.consistent = false;
      report.findings.push_back(std::move(f));
    }
    return report;
  }

  // Of the numbers of a finding: where a tolerance is a share, the finding tells the whole.
  std::string unit_of(const Violation& v) const {
    const bool prismatic = v.kind >= Kind::joint_position && v.kind <= Kind::servo_step &&
                           model_.dofs()[v.item].prismatic;
    switch (v.kind) {
      case Kind::fz_residual:
      case Kind::unilateral:
        return "N";
      case Kind::joint_position:
      case Kind::servo_step:
        return prismatic ? "m" : "rad";
      case Kind::joint_speed:
        return prismatic ? "m/s" : "rad/s";
      case Kind::joint_acceleration:
        return prismatic ? "m/s^2" : "rad/s^2";
      case Kind::joint_torque:
      case Kind::continuous_torque:
        return prismatic ? "N" : "N m";
      default:
        return finding_kinds()[static_cast<int>(v.kind)].unit;
    }
  }

  const RobotModel& model_;
  const CommandSeries& series_;
  const std::array<double, kKindCount> tolerance_;
  const double friction_;
  const ActuatorLimits& limits_;
  const ContactPlan plan_;
  const CollisionModel collisions_;
  RobotData data_;
  const double weight_;
  FindingWindows windows_;
  CheckSummary summary_;
  Eigen::MatrixXd square_sum_;  // of torques up to a sample, by joint
  std::array<int, 2> plane_of_ = {-1, -1};
  std::array<Isometry3d, 2> soles_ = {Isometry3d::Identity(), Isometry3d::Identity()};
  SupportPlane plane_;
};

}  // namespace

ConsistencyReport check_consistency(const RobotModel& model, const CommandSeries& series,
                                    const CheckOptions& options) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": has no soles, so nothing can be said about its "
                                   "contacts; name them in the sidecar");
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern, "the command series is empty: nothing to check");
  if (!(series.dt > 0)) fail(ErrorCode::usage, "the command series has no sample time");
  return Checker(model, series, options).run();
}

}  // namespace ayumi
