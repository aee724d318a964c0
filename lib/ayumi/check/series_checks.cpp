// What takes more than one sample to tell.
#include <algorithm>
#include <cmath>

#include "ayumi/check/check_pass.hpp"
#include "ayumi/demand/collision_scan.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

namespace {

constexpr double kRefineBelow = 0.010;  // clearance that is worth every sample [m]

void note_clearance(CheckPass& pass, int pair, int k, double clearance) {
  pass.summary.min_self_clearance = std::min(pass.summary.min_self_clearance, clearance);
  const double wanted = pass.tolerance(FindingKind::self_collision);
  if (clearance < wanted)
    pass.add(FindingKind::self_collision, pair, k, clearance, clearance < 0 ? 0 : wanted,
             -clearance, 0, clearance < 0 ? Severity::error : Severity::warning);
}

}  // namespace

void check_angular_momentum(CheckPass& pass) {
  constexpr int kMean = 2;  // samples to either side
  const double limit = pass.tolerance(FindingKind::angular_momentum);
  const auto flies = [&](int k) {
    return k >= 0 && k < pass.count() && pass.series.samples[k].support == Support::none &&
           !pass.at_flight_edge(k);
  };
  for (int k = 0; k < pass.count(); ++k) {
    if (!flies(k)) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int samples = 0;
    for (int i = k - kMean; i <= k + kMean; ++i) {
      if (!flies(i)) continue;
      sum += pass.flight_moment[i];
      ++samples;
    }
    const Eigen::Vector3d mean = sum / samples;
    const double size = mean.norm();
    raise_to(pass.summary.max_momentum_rate, size);
    int axis = 0;
    mean.cwiseAbs().maxCoeff(&axis);
    if (size > limit) pass.add(FindingKind::angular_momentum, 0, k, size, limit, size, axis);
  }
}

// Speed may change where a flight begins or ends, place may not: what the COG goes between the two
// samples is the mean of what it goes before and after.
void check_leaps(CheckPass& pass) {
  constexpr double kLeap = 1e-3;  // [m]
  const auto flies = [&](int k) { return pass.series.samples[k].support == Support::none; };
  const double limit = kLeap / (pass.series.dt * pass.series.dt);
  for (int k = 2; k + 1 < pass.count(); ++k) {
    if (flies(k) == flies(k - 1)) continue;
    const std::vector<Eigen::Vector3d>& c = pass.cog;
    const Eigen::Vector3d beside = 0.5 * (c[k + 1] - c[k] + c[k - 1] - c[k - 2]);
    const Eigen::Vector3d leap = c[k] - c[k - 1] - beside;
    const double size = leap.norm() / (pass.series.dt * pass.series.dt);
    int axis = 0;
    leap.cwiseAbs().maxCoeff(&axis);
    if (size > limit)
      pass.add(FindingKind::ballistic, kMotionLeaps, flies(k) ? k : k - 1, size, limit, size, axis);
  }
}

void check_servo_steps(CheckPass& pass) {
  const double period = pass.model.description().servo_period, dt = pass.series.dt;
  const int ticks = std::max(1, static_cast<int>(std::lround(period / dt)));
  const double most = pass.tolerance(FindingKind::servo_step);
  for (int k = ticks; k < pass.count(); ++k) {
    const RobotState& from = pass.series.samples[k - ticks].state;
    const RobotState& to = pass.series.samples[k].state;
    for (int i = 0; i < pass.model.dof_count(); ++i) {
      const double limit = pass.limits.speed[i], allowed = limit * ticks * dt;
      if (!std::isfinite(allowed)) continue;
      const double step = to.theta[i] - from.theta[i], ratio = std::abs(step) / allowed;
      raise_to(pass.summary.max_servo_step, ratio);
      const double planned = std::max(std::abs(from.dtheta[i]), std::abs(to.dtheta[i]));
      // Half a percent: the mean speed of a tick is not the speed at its ends.
      if (ratio > 1.005 * most && planned <= limit)
        pass.add(FindingKind::servo_step, i, k, step, most * allowed, ratio);
    }
  }
}

void check_servo_targets(CheckPass& pass) {
  const double period = pass.model.description().servo_period, dt = pass.series.dt;
  const int ticks = std::max(1, static_cast<int>(std::lround(period / dt)));
  const Eigen::VectorXd lead = servo_lead(pass.model);
  const double most = pass.tolerance(FindingKind::servo_step);
  const auto target = [&](int k, int i) {
    const RobotState& s = pass.series.samples[k].state;
    return s.theta[i] + lead[i] * s.dtheta[i];
  };
  for (int k = ticks; k < pass.count(); ++k) {
    for (int i = 0; i < pass.model.dof_count(); ++i) {
      const double limit = pass.limits.speed[i], allowed = most * limit * ticks * dt;
      // A joint that is itself too fast is told as such.
      if (!std::isfinite(allowed) ||
          std::abs(pass.series.samples[k].state.dtheta[i]) > most * limit)
        continue;
      const double step = target(k, i) - target(k - ticks, i), ratio = std::abs(step) / allowed;
      if (ratio > 1.005)
        pass.targets.add(
            {FindingKind::servo_step, i, k, Severity::warning, step, allowed, ratio, kServoTarget});
    }
  }
}

void check_continuous_torque(CheckPass& pass) {
  const int whole = static_cast<int>(std::lround(pass.limits.thermal_window / pass.series.dt));
  const int window = std::clamp(whole, 1, pass.count());
  const Severity severity = pass.count() >= whole ? Severity::error : Severity::warning;
  const double most = pass.tolerance(FindingKind::continuous_torque);
  for (int i = 0; i < pass.model.dof_count(); ++i) {
    const double limit = pass.limits.continuous_torque[i];
    if (!std::isfinite(limit)) continue;
    for (int end = window; end <= pass.count(); ++end) {
      const double mean = (pass.square_sum(i, end) - pass.square_sum(i, end - window)) / window;
      const double rms = std::sqrt(std::max(0.0, mean));
      raise_to(pass.summary.max_continuous_torque_ratio, rms / limit);
      if (rms > most * limit)
        pass.add(FindingKind::continuous_torque, i, end - 1, rms, most * limit, rms / limit, 0,
                 severity);
    }
  }
}

void check_self_collision(CheckPass& pass) {
  const double near = pass.tolerance(FindingKind::self_collision) + kRefineBelow;
  scan_clearance(
      pass.model, pass.series, pass.collisions, near,
      [&pass](int pair, int k, double clearance) { note_clearance(pass, pair, k, clearance); });
}

}  // namespace ayumi
