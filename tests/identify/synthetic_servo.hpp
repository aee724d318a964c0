#pragma once
// A pendulum on a servo, simulated by other means than those of the estimator: symplectic Euler at
// 1/100 of the sampling time, dry friction as an impulse, and an encoder with noise and counts.

#include <cmath>
#include <functional>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

struct SyntheticServo {
  double kp = 800, kd = 2, viscous = 1.5, coulomb = 0.4, delay = 0.0036, offset = 0.004;
  double rotor_inertia = 0.004;
  double backlash = 0;
  // The link: its mass and lever, and the rest of its inertia about the axis.
  double mass = 1.2, length = 0.15, own_inertia = 0.002;
  double inertia() const { return own_inertia + mass * length * length; }
};

/// A trunk with one link that hangs from it.
inline RobotDescription pendulum_robot(const SyntheticServo& servo) {
  RobotDescription robot;
  robot.name = "pendulum";
  LinkDescription trunk, arm;
  trunk.name = "trunk";
  trunk.has_inertial = arm.has_inertial = true;
  trunk.inertia.mass = 5;
  trunk.inertia.about_com = 0.05 * Eigen::Matrix3d::Identity();
  arm.name = "arm";
  arm.inertia.mass = servo.mass;
  arm.inertia.com = {0, 0, -servo.length};
  arm.inertia.about_com = servo.own_inertia * Eigen::Matrix3d::Identity();
  robot.links = {trunk, arm};
  JointDescription joint;
  joint.name = "arm_joint";
  joint.type = JointType::revolute;
  joint.parent = "trunk";
  joint.child = "arm";
  joint.axis = Eigen::Vector3d::UnitY();
  joint.has_limits = true;
  joint.lower = -2;
  joint.upper = 2;
  robot.joints = {joint};
  robot.postures["home"] = {};
  ServoDescription given;
  given.kp = 600;  // the value in the file
  given.kd = servo.kd;
  given.rotor_inertia = servo.rotor_inertia;
  robot.servos["arm_joint"] = given;
  return robot;
}

/// A slow sweep, a chirp and steps, for 6 s.
inline double excitation(double t) {
  if (t < 2.4) return 0.7 * std::sin(2 * M_PI * t / 2.4);
  if (t < 4.4) {
    const double s = t - 2.4;
    return 0.25 * std::sin(2 * M_PI * (0.5 * s + 1.625 * s * s));
  }
  // Each step takes 50 ms with minimum jerk.
  const double levels[] = {0.0, 0.2, 0.45, 0.1, -0.2, -0.5, -0.1, 0.1, 0.1};
  const int step = std::min(7, static_cast<int>((t - 4.4) / 0.2));
  const double u = std::min(1.0, (t - 4.4 - 0.2 * step) / 0.05);
  const double from = step > 0 ? levels[step - 1] : levels[0];
  return from + (levels[step] - from) * u * u * u * (10 - 15 * u + 6 * u * u);
}

/// The angles at 1 kHz without noise.
inline Eigen::VectorXd simulated_angles(const SyntheticServo& servo, double seconds,
                                        const std::function<double(double)>& command) {
  const int rows = static_cast<int>(std::lround(seconds * 1000)) + 1, fine = 100;
  const double h = 0.001 / fine, inertia = servo.inertia() + servo.rotor_inertia;
  Eigen::VectorXd theta(rows);
  double phi = command(0), rate = 0;
  for (int k = 0; k < rows; ++k) {
    const double load = servo.mass * kGravity * servo.length * std::sin(phi);
    theta[k] = phi + servo.offset - 0.5 * servo.backlash * std::clamp(load / 0.02, -1.0, 1.0);
    for (int i = 0; i < fine; ++i) {
      const double t = 0.001 * (k + static_cast<double>(i) / fine) - servo.delay;
      double impulse = servo.kp * (command(std::max(0.0, t)) - phi) -
                       (servo.kd + servo.viscous) * rate -
                       servo.mass * kGravity * servo.length * std::sin(phi);
      impulse = inertia * rate + h * impulse;
      const double dry = h * servo.coulomb;
      impulse -= std::clamp(impulse, -dry, dry);
      rate = impulse / inertia;
      phi += h * rate;
    }
  }
  return theta;
}

/// The recording of `theta` by an encoder with the resolution `count` [rad] and with noise of the
/// standard deviation `noise` [rad].
inline RecordedMotion recorded(const Eigen::VectorXd& theta, double noise, double count,
                               std::uint64_t seed, const std::function<double(double)>& command) {
  RecordedMotion motion;
  Random random(seed);
  for (AngleTable* table : {&motion.command, &motion.measured}) {
    table->dt = 0.001;
    table->theta.resize(theta.size(), 1);
    table->has = {1};
    table->resolution = Eigen::VectorXd::Constant(1, count);
  }
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    motion.command.theta(k, 0) = command(0.001 * static_cast<double>(k));
    motion.measured.theta(k, 0) = count * std::round((theta[k] + noise * random.normal()) / count);
  }
  return motion;
}

}  // namespace ayumi::test
