#include "ayumi/sim/servo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

double gear_stiffness(const ServoDescription& servo) {
  return servo.gear_stiffness > 0 ? servo.gear_stiffness : kGearStiffness * servo.kp;
}

double gear_damping(const ServoDescription& servo) {
  if (servo.gear_damping > 0) return servo.gear_damping;
  return 2 * std::sqrt(gear_stiffness(servo) * servo.rotor_inertia);
}

double available_torque(const ActuatorLimits& limits, int dof, double rate, double direction) {
  const double peak = limits.peak_torque[dof];
  const double speed = limits.speed[dof];
  if (rate * direction <= speed || !std::isfinite(speed)) return peak;
  // The factor is 1 at the speed limit and 0 at 1.1 times the speed limit.
  return peak * std::clamp(11.0 - 10.0 * rate * direction / speed, 0.0, 1.0);
}

double voltage_torque(const ServoDescription& servo, double rate, double direction) {
  if (servo.stall_torque <= 0) return std::numeric_limits<double>::infinity();
  return servo.stall_torque - servo.back_emf * rate * direction;
}

TorqueRange torque_range(const ActuatorLimits& limits, int dof, double rate) {
  const ServoDescription& servo = limits.servo[static_cast<size_t>(dof)];
  const double up = available_torque(limits, dof, rate, 1),
               down = available_torque(limits, dof, rate, -1);
  TorqueRange range{-down, up};
  if (servo.stall_torque <= 0) return range;
  const double forward = voltage_torque(servo, rate, 1), back = voltage_torque(servo, rate, -1);
  range.high_by_voltage = forward < up;
  range.low_by_voltage = back < down;
  if (range.high_by_voltage) range.high = forward;
  if (range.low_by_voltage) range.low = -back;
  if (range.low > range.high && rate > 0) {
    range.low = range.high;
    range.low_by_voltage = true;
  } else if (range.low > range.high) {
    range.high = range.low;
    range.high_by_voltage = true;
  }
  return range;
}

TorqueBound torque_bound(const ActuatorLimits& limits, int dof, double rate, double direction) {
  const TorqueRange range = torque_range(limits, dof, rate);
  const double v = rate * direction, peak = limits.peak_torque[dof], speed = limits.speed[dof];
  if (direction > 0 ? range.high_by_voltage : range.low_by_voltage) {
    const double slope = limits.servo[static_cast<size_t>(dof)].back_emf;
    return {TorquePiece::voltage, (direction > 0 ? range.high : -range.low) + slope * v, slope};
  }
  if (v <= speed || !std::isfinite(speed)) return {TorquePiece::peak, peak, 0};
  if (v >= 1.1 * speed) return {};
  return {TorquePiece::fall, 11 * peak, 10 * peak / speed};
}

double dry_friction(const ServoDescription& servo, double rate, double motor, double external) {
  const LoadFriction& load = servo.load;
  double friction = servo.coulomb + std::abs(load.external * external - load.motor * motor);
  if (servo.stribeck_rate <= 0) return friction;
  const double share = std::abs(rate) / servo.stribeck_rate;
  const double s = elementary::exp(-elementary::power(share, servo.stribeck_exponent));
  double at_rest = servo.stribeck_torque +
                   std::abs(load.external_stribeck * external - load.motor_stribeck * motor);
  if (external * motor < 0)
    at_rest += std::abs(motor) > std::abs(external) ? load.external_quadratic * external * external
                                                    : load.motor_quadratic * motor * motor;
  return friction + s * at_rest;
}

ServoError servo_error(const ServoDescription& servo, const Dof& dof, double target, double phi) {
  double reading = phi - servo.offset;
  ServoError error{target + servo.offset};
  if (servo.quantized) {
    const double counts = std::abs(dof.encoder.counts_per_degree) * 180 / M_PI;
    if (counts > 0) {
      const double rounded = std::round(reading * counts) / counts;
      target = std::round(target * counts) / counts;
      error.target = target + phi - rounded;
      reading = rounded;
    }
  }
  if (servo.dead_band > 0) {
    const double e = target - reading;
    error.inside = std::abs(e) <= servo.dead_band;
    error.target -= std::clamp(e, -servo.dead_band, servo.dead_band);
  }
  return error;
}

TargetDelay::TargetDelay(const std::vector<ServoDescription>& servos) {
  for (const ServoDescription& servo : servos) {
    delay_.push_back(servo.delay);
    longest_ = std::max(longest_, servo.delay);
  }
}

const Eigen::VectorXd& TargetDelay::step(const Eigen::VectorXd& targets, double dt) {
  if (longest_ <= 0) return now_ = targets;
  const auto needed = static_cast<Eigen::Index>(std::ceil(longest_ / dt)) + 2;
  if (needed > ring_.cols()) {
    // Moves the newest column to the last filled place, so that the order is kept in the larger
    // ring.
    Eigen::MatrixXd larger(targets.size(), needed);
    std::vector<double> dts(static_cast<size_t>(needed), dt);
    for (Eigen::Index k = 0; k < count_; ++k) {
      const Eigen::Index from = (newest_ - k + ring_.cols()) % ring_.cols();
      larger.col(count_ - 1 - k) = ring_.col(from);
      dts[static_cast<size_t>(count_ - 1 - k)] = dt_[static_cast<size_t>(from)];
    }
    ring_ = std::move(larger);
    dt_ = std::move(dts);
    newest_ = count_ - 1;
  }
  newest_ = count_ > 0 ? (newest_ + 1) % ring_.cols() : 0;
  count_ = std::min(count_ + 1, ring_.cols());
  ring_.col(newest_) = targets;
  dt_[static_cast<size_t>(newest_)] = dt;
  now_.resize(targets.size());
  for (Eigen::Index j = 0; j < targets.size(); ++j)
    now_[j] = delay_[static_cast<size_t>(j)] > 0 ? mean(j, delay_[static_cast<size_t>(j)], dt)
                                                 : targets[j];
  return now_;
}

// The command of `delay` ago covers the interval [-delay, dt - delay], with the time 0 at the start
// of the step. The newest column, number 0, holds over [0, dt], column 1 before 0, and so on.
double TargetDelay::mean(Eigen::Index joint, double delay, double dt) const {
  double sum = 0, missing = dt, end = dt;  // `end`: end of the column's time
  const double from = -delay, to = dt - delay;
  for (Eigen::Index k = 0; k < count_ && missing > 0; ++k) {
    const Eigen::Index column = (newest_ - k + ring_.cols()) % ring_.cols();
    const double begin = end - dt_[static_cast<size_t>(column)];
    const double overlap = std::min(std::min(end, to) - std::max(begin, from), missing);
    if (overlap > 0) {
      sum += overlap * ring_(joint, column);
      missing -= overlap;
    }
    end = begin;
  }
  const Eigen::Index oldest = (newest_ - count_ + 1 + ring_.cols()) % ring_.cols();
  return (sum + std::max(missing, 0.0) * ring_(joint, oldest)) / dt;
}

}  // namespace ayumi
