#include "ayumi/sim/fall_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Thresholds of the verdict. docs/cli.md, "Simulating", defines them for users.

/// Tilt of the trunk against the ground's normal beyond which the robot has fallen [rad]. Chosen:
/// 46 deg is beyond the postures of the bundled patterns and long before the trunk touches the
/// ground. Its effect is in constants.md.
constexpr double kFallTilt = 0.8;
/// Cosine of a tilt above which the robot certainly has not fallen, so that the angle need not be
/// computed. Definition: above the cosine of kFallTilt, 0.697.
constexpr double kSurelyUpright = 0.75;
/// Fraction of the commanded COG height below which the robot has fallen. Chosen: lower than a
/// robot with bent knees under its load, higher than one that sits or lies. Its effect is in
/// constants.md.
constexpr double kFallHeight = 0.6;
/// Tilt of the trunk below which a robot stands at the end [rad]. Chosen: a quarter of kFallTilt.
/// No measured case changes between half and twice the value (constants.md).
constexpr double kRestTilt = 0.2;
/// Horizontal COG error at the end below which a robot stands, in units of the COG height z.
/// Chosen: 22 mm for HOAP-1 (z 0.245 m), whose soles reach 42 mm behind and 56 mm in front of the
/// ankle. No measured case changes between half and twice the value (constants.md).
constexpr double kRestError = 0.09;
/// COG speed at the end below which a robot stands, in units of omega z. Chosen: the speed that
/// moves the DCM by 0.054 z, which is 13 mm for HOAP-1 and keeps it inside the soles. No measured
/// case changes between half and twice the value (constants.md).
constexpr double kRestSpeed = 0.054;
/// Amplitude of an oscillating ZMP below which a robot stands at the end, in units of z. Chosen: 5
/// mm on HOAP-1. The noise of its sensors moves the ZMP of a robot that stands by 1.4 mm under DTAD
/// and 2.6 mm under VIIP, and feet that hammer move it by 68 mm and more.
constexpr double kRestZmp = 0.02;
/// Time at the end in which the ZMP must be at rest [s]. Chosen: several periods of the slowest
/// oscillation that is searched for, and shorter than the time (1 s) for which a run continues
/// after its motion.
constexpr double kRestTime = 0.5;
/// Slowest oscillation of the ZMP that is searched for [Hz]. Chosen: faster than any step, and
/// slower than the rocking of a robot on soft soles. Slower motions are judged by the COG.
constexpr double kSlowestRocking = 3;
/// Time off the ground after which the robot is in flight [s]. Chosen: a shorter one is a rebound.
/// Its effect is in constants.md.
constexpr double kMinFlight = 0.04;
/// Time off the ground after which the next contact of a foot is a touchdown [s]. Chosen: a shorter
/// one is a rebound. Its effect is in constants.md.
constexpr double kMinFootFlight = 0.03;
/// Number of events for which memory is reserved, so that a tick allocates nothing in a usual run.
constexpr size_t kReservedEvents = 64;

/// The rigid motion that takes the planned soles onto the real ones, and the level ground of the
/// plan onto the real ground: the mean place, heading and slope. On a slope, the plan is inclined
/// with the feet.
Isometry3d plan_to_world(const RobotModel& model, const RobotData& data,
                         const CommandSample& command, const Vector3d& normal) {
  Vector3d plan = Vector3d::Zero(), real = Vector3d::Zero();
  double sine = 0, cosine = 0;
  int count = 0;
  for (Side side : {Side::left, Side::right}) {
    if (command.support != Support::none && !supports(command.support, side)) continue;
    const Isometry3d& p = command.feet[static_cast<int>(side)];
    const Isometry3d r = sole_pose(model, data, side);
    plan += p.translation();
    real += r.translation();
    const Vector2d from = p.linear().block<2, 1>(0, 0).normalized();
    const Vector2d to = r.linear().block<2, 1>(0, 0).normalized();
    sine += from.x() * to.y() - from.y() * to.x();
    cosine += from.dot(to);
    ++count;
  }
  // The mean heading of the soles is kept as a direction, without computing an angle.
  const double length = std::sqrt(sine * sine + cosine * cosine);
  Eigen::Matrix3d about_z = Eigen::Matrix3d::Identity();
  if (length > 0) {
    about_z(0, 0) = about_z(1, 1) = cosine / length;
    about_z(1, 0) = sine / length;
    about_z(0, 1) = -about_z(1, 0);
  }
  Isometry3d turn = Isometry3d::Identity();
  turn.linear() = rotation_between(Vector3d::UnitZ(), normal).toRotationMatrix() * about_z;
  turn.translation() = real / count - turn.linear() * plan / count;
  return turn;
}

}  // namespace

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::stands:
      return "stands";
    case Outcome::unsettled:
      return "unsettled";
    case Outcome::fell:
      return "fell";
  }
  return "";
}

FallMonitor::FallMonitor(const RobotModel& model, const ActuatorLimits& limits, const World& world)
    : model_(&model), limits_(limits) {
  Isometry3d ground = Isometry3d::Identity();
  ground.linear() = exp_rotation({world.slope.x(), world.slope.y(), 0}).toRotationMatrix();
  set_ground(ground);
  events_.reserve(kReservedEvents);
}

bool FallMonitor::observe(double t, const CommandSample& command, const SimulationSample& sample,
                          const RobotData& truth, const StepReport& report, double dt) {
  if (result_.fell_at < 0) observe_figures(t, command, sample, truth, report, dt);
  return observe_verdict(t, command, sample, truth, report, dt);
}

void FallMonitor::observe_figures(double t, const CommandSample& command,
                                  const SimulationSample& sample, const RobotData& truth,
                                  const StepReport& report, double dt) {
  const double weight = model_->mass() * kGravity;
  SimulationResult& r = result_;
  // In flight the command rises, too, so the apex is relative to the height at lift-off.
  if (command.support != Support::none) level_ = command.cog.z();
  r.max_penetration = std::max(r.max_penetration, report.max_penetration);
  r.max_contact_residual = std::max(r.max_contact_residual, report.contact_residual);
  r.max_contact_iterations = std::max(r.max_contact_iterations, report.contact_iterations);
  iterations_ += static_cast<double>(report.contact_iterations);
  r.mean_contact_iterations = iterations_ / static_cast<double>(++ticks_);
  const auto raise = [t](JointShare& most, int joint, double ratio) {
    if (ratio > most.ratio) most = {ratio, joint, t};
  };
  for (int j = 0; j < model_->dof_count(); ++j) {
    raise(r.speed, j, std::abs(sample.state.dtheta[j]) / limits_.speed[j]);
    raise(r.torque, j, std::abs(sample.torque[j]) / limits_.peak_torque[j]);
  }
  if (sample.fz > kTouchLoad * weight) {
    zmp_square_sum_ += (sample.measured_zmp - sample.reference_zmp).head<2>().squaredNorm();
    ++zmp_count_;
    airborne_ = flight_apex_ = 0;
  } else {
    const bool counted = airborne_ > kMinFlight;
    airborne_ += dt;
    flight_apex_ = std::max(flight_apex_, sample.cog.z() - level_);
    if (airborne_ > kMinFlight) {
      r.flight += counted ? dt : airborne_;
      r.apex = std::max(r.apex, flight_apex_);
    }
  }
  observe_feet(t, command, truth, report, dt);
}

bool FallMonitor::observe_verdict(double t, const CommandSample& command,
                                  const SimulationSample& sample, const RobotData& truth,
                                  const StepReport& report, double dt) {
  SimulationResult& r = result_;
  if (r.fell_at >= 0) return false;
  const double weight = model_->mass() * kGravity;
  const Vector3d up = truth.rotation[model_->trunk_body()].col(2);
  const double upright = std::clamp(up.dot(normal()), -1.0, 1.0);
  if (upright < least_upright_) {
    least_upright_ = upright;
    r.max_tilt = elementary::acos(upright);
  }
  if (sample.fz > kTouchLoad * weight) {
    tick_ = dt;
    const auto kept = static_cast<size_t>(std::lround(kRestTime / dt));
    if (last_zmp_.capacity() < kept) last_zmp_.reserve(kept);
    if (last_zmp_.size() < kept)
      last_zmp_.push_back(sample.zmp.head<2>());
    else
      last_zmp_[next_zmp_] = sample.zmp.head<2>();
    next_zmp_ = (next_zmp_ + 1) % kept;
  }
  std::string reason;
  const double tilt = upright > kSurelyUpright ? 0.0 : elementary::acos(upright);
  const auto height = [&] { return (to_ground_ * sample.cog).z(); };
  if (tilt > kFallTilt)
    reason = "trunk tilt " + text::fixed(tilt * 180 / EIGEN_PI, 1) + " deg";
  else if (height() < kFallHeight * (command.cog.z() - command.zmp.z()))
    reason = "COG at " + text::fixed(height(), 3) + " m";
  else if (report.body_contact)
    reason = report.touching_body < 0
                 ? "a part other than a foot touched the ground"
                 : model_->bodies()[static_cast<size_t>(report.touching_body)].name +
                       " touched the ground";
  if (reason.empty()) return false;
  r.fell_at = t;
  events_.push_back({t, EventKind::fell, reason});
  return true;
}

void FallMonitor::observe_feet(double t, const CommandSample& command, const RobotData& truth,
                               const StepReport& report, double dt) {
  const double weight = model_->mass() * kGravity;
  const Isometry3d to_world = plan_to_world(*model_, truth, command, normal());
  const Vector3d cog = to_world.inverse() * truth.cog;
  largest_.cog = std::max(largest_.cog, (cog - command.cog).head<2>().norm());
  for (Side side : {Side::left, Side::right}) {
    const int i = static_cast<int>(side);
    double fz = 0;
    for (const SoleForce& cell : report.soles[i]) fz += normal().dot(cell.force);
    const bool loaded = fz > kTouchLoad * weight;
    // A foot that still touches the ground has not left it, however small its load is. When it has
    // been off the ground for long enough, its next load is a touchdown.
    const bool lifted = unloaded_[i] > kMinFootFlight;
    if (loaded && lifted) {
      ++result_.steps;
      events_.push_back({t, EventKind::touchdown, std::string(name_of(side)) + " foot"});
    }
    if (fz <= 0)
      unloaded_[i] += dt;
    else if (loaded || !lifted)
      unloaded_[i] = 0;
    // Slip is measured from the place where the foot first carried load in its stance.
    const bool stance = supports(command.support, side) && loaded;
    const Isometry3d sole = sole_pose(*model_, truth, side);
    const Vector3d place = to_ground_ * sole.translation();
    if (stance && !in_stance_[i]) stance_start_[i] = place;
    if (stance) {
      const double slip = (place - stance_start_[i]).head<2>().norm();
      result_.max_slip = std::max(result_.max_slip, slip);
      const Vector3d planned = to_world.linear() * command.feet[i].linear().col(2);
      const double level = std::clamp(planned.dot(sole.linear().col(2)), -1.0, 1.0);
      if (level < least_level_) {
        least_level_ = level;
        largest_.foot_tilt = elementary::acos(level);
      }
    }
    in_stance_[i] = supports(command.support, side) && (in_stance_[i] || loaded);
  }
}

// The amplitude and frequency of the last ZMPs relative to their straight line, on the axis with
// the larger motion.
void FallMonitor::judge_zmp() {
  const auto count = static_cast<Eigen::Index>(last_zmp_.size());
  if (static_cast<double>(count) * tick_ < 0.999 * kRestTime) return;
  Eigen::MatrixX2d zmp(count, 2);
  for (Eigen::Index k = 0; k < count; ++k)
    zmp.row(k) = last_zmp_[(next_zmp_ + static_cast<size_t>(k)) % last_zmp_.size()].transpose();
  zmp.rowwise() -= Eigen::RowVector2d(zmp.colwise().mean());
  const double half = 0.5 * static_cast<double>(count - 1);
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(count, -half, half);
  const Eigen::RowVector2d slope = time.transpose() * zmp / std::max(1.0, time.squaredNorm());
  for (Eigen::Index k = 0; k < count; ++k) zmp.row(k) -= time[k] * slope;
  Eigen::Index axis = 0;
  const double rms =
      std::sqrt(zmp.colwise().squaredNorm().maxCoeff(&axis) / static_cast<double>(count));
  int crossings = 0;
  for (Eigen::Index k = 1; k < count; ++k)
    crossings += (zmp(k, axis) > 0) != (zmp(k - 1, axis) > 0);
  const double frequency = crossings / (2 * kRestTime);
  if (frequency < kSlowestRocking) return;
  result_.zmp_amplitude = std::sqrt(2.0) * rms;
  result_.zmp_frequency = frequency;
}

SimulationResult FallMonitor::conclude(const CommandSample& command, const RobotState& state) {
  SimulationResult& r = result_;
  RobotData data(*model_);
  update_velocities(*model_, state, data);
  r.zmp_tracking_rms =
      zmp_count_ > 0 ? std::sqrt(zmp_square_sum_ / static_cast<double>(zmp_count_)) : 0.0;
  const Vector3d cog = plan_to_world(*model_, data, command, normal()).inverse() * data.cog;
  r.final_cog_error = (cog - command.cog).head<2>().norm();
  r.final_speed = data.dcog.norm();
  if (r.fell_at >= 0) {
    r.outcome = Outcome::fell;
    return r;
  }
  judge_zmp();
  const double z = command.cog.z() - command.zmp.z();
  const double omega = std::sqrt(kGravity / z);
  const Vector3d up = data.rotation[model_->trunk_body()].col(2);
  const double tilt = elementary::acos(std::clamp(up.dot(normal()), -1.0, 1.0));
  const bool rest = r.final_cog_error < kRestError * z && r.final_speed < kRestSpeed * omega * z &&
                    tilt < kRestTilt && r.zmp_amplitude < kRestZmp * z;
  r.outcome = rest ? Outcome::stands : Outcome::unsettled;
  return r;
}

}  // namespace ayumi
