// One pass over the samples in order of time: inverse dynamics gives what the motion needs from the
// ground, residuals.hpp tells it against command, support, feet and motors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/check/check_pass.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kLightShare = 0.25;  // of the weight: below it a ZMP error may be larger

int largest_axis(const Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

void check_vector(CheckPass& pass, FindingKind kind, int k, const Vector3d& residual,
                  double& maximum, Severity severity = Severity::error, int item = 0,
                  double allowance = 1) {
  const double size = residual.norm();
  raise_to(maximum, size);
  const double limit = allowance * pass.tolerance(kind);
  if (size > limit) pass.add(kind, item, k, size, limit, size, largest_axis(residual), severity);
}

// In flight nothing pushes, whatever the motion does: the commanded force must be zero.
void check_vertical_force(CheckPass& pass, int k, double needed) {
  const double residual = needed - pass.series.samples[k].fz;
  raise_to(pass.summary.max_fz_residual, std::abs(residual));
  const double limit = pass.tolerance(FindingKind::fz_residual) * pass.weight;
  if (std::abs(residual) > limit)
    pass.add(FindingKind::fz_residual, 0, k, residual, limit, std::abs(residual));
}

void check_zmp_command(CheckPass& pass, int k, const SampleDynamics& motion) {
  const CommandSample& s = pass.series.samples[k];
  // Where the ground hardly pushes, a ZMP error is hardly a moment.
  const double light = kLightShare * pass.weight / std::max(s.fz, 1e-3 * pass.weight);
  check_vector(pass, FindingKind::zmp_residual, k, motion.use.zmp_world - s.zmp,
               pass.summary.max_zmp_residual, Severity::error, 0, std::max(1.0, light));
  const Vector3d point_mass = pendulum_zmp(pass.dynamics.data().cog, motion.ddcog, s.zmp.z());
  check_vector(pass, FindingKind::point_mass_gap, k, point_mass - s.zmp,
               pass.summary.max_point_mass_gap, Severity::info);
}

void check_margin(CheckPass& pass, int k, int whose, double margin) {
  const double wanted = pass.tolerance(FindingKind::support_margin);
  if (margin >= wanted - kRounding) return;
  const bool outside = margin < -kRounding;
  pass.add(FindingKind::support_margin, whose, k, margin, outside ? 0 : wanted, -margin,
           static_cast<int>(pass.series.samples[k].support),
           outside ? Severity::error : Severity::warning);
}

void check_margins(CheckPass& pass, int k, const GroundDemand& use) {
  const CommandSample& s = pass.series.samples[k];
  const SupportPlane& plane = pass.dynamics.plane();
  pass.summary.min_zmp_margin = std::min(pass.summary.min_zmp_margin, use.margin);
  check_margin(pass, k, 0, use.margin);
  const Vector3d command = plane.frame.inverse() * s.zmp;
  const double command_margin = plane.polygon.margin(command.head<2>());
  // The commanded ZMP tells something of its own only where the motion's ZMP is another one.
  if ((use.zmp_world - s.zmp).norm() > pass.tolerance(FindingKind::zmp_residual) &&
      command_margin < -kRounding)
    check_margin(pass, k, 1, command_margin);
}

void check_grip(CheckPass& pass, int k, const GroundDemand& use) {
  const int support = static_cast<int>(pass.series.samples[k].support);
  const double grip = pass.friction * use.normal_force;
  const double ratio = use.tangential_force / grip;
  raise_to(pass.summary.max_friction_ratio, ratio);
  const double most = pass.tolerance(FindingKind::friction);
  if (ratio > most) pass.add(FindingKind::friction, 0, k, ratio, most, ratio, support);
  // Nothing resists turning where the foot slides anyway, and a ZMP outside has no lever: both
  // are told above.
  if (ratio >= 1 || use.margin <= pass.tolerance(FindingKind::support_margin)) return;
  const double lever = torsional_friction_arm(pass.dynamics.plane().polygon, use.zmp);
  const double yaw = std::abs(use.yaw_moment) / (grip * lever);
  raise_to(pass.summary.max_yaw_ratio, yaw);
  const double most_yaw = pass.tolerance(FindingKind::yaw_moment);
  if (yaw > most_yaw) pass.add(FindingKind::yaw_moment, 0, k, yaw, most_yaw, yaw, support);
}

void check_ground(CheckPass& pass, int k, const SampleDynamics& motion) {
  const GroundDemand& use = motion.use;
  const double least = pass.tolerance(FindingKind::unilateral) * pass.weight;
  if (use.normal_force < least) {
    const bool pulls = use.normal_force < 0;
    pass.add(FindingKind::unilateral, 0, k, use.normal_force, pulls ? 0 : least, -use.normal_force,
             static_cast<int>(pass.series.samples[k].support),
             pulls ? Severity::error : Severity::warning);
  }
  if (!use.has_zmp) return;
  check_zmp_command(pass, k, motion);
  check_margins(pass, k, use);
  check_grip(pass, k, use);
}

// Fourth-order second difference of the commanded COG; all five samples are in the same flight.
Vector3d commanded_acceleration(const CommandSeries& series, int k) {
  const auto cog = [&](int i) { return series.samples[i].cog; };
  return (16 * (cog(k - 1) + cog(k + 1)) - (cog(k - 2) + cog(k + 2)) - 30 * cog(k)) /
         (12 * series.dt * series.dt);
}

void check_flight(CheckPass& pass, int k, const SampleDynamics& motion) {
  const Vector3d gravity(0, 0, -kGravity);
  check_vector(pass, FindingKind::ballistic, k, motion.ddcog - gravity,
               pass.summary.max_ballistic_residual);
  if (k >= 2 && k + 2 < pass.count())
    check_vector(pass, FindingKind::ballistic, k, commanded_acceleration(pass.series, k) - gravity,
                 pass.summary.max_ballistic_residual, Severity::error, kCommandFalls);
  pass.flight_moment[k] = motion.moment;
}

// The ground below a swinging foot: the lower of where it stood and where it will stand.
double swing_depth(const CheckPass& pass, Side side, int k, const Isometry3d& sole) {
  const int s = static_cast<int>(side);
  const int i = pass.plan.index[s][k];
  double depth = std::numeric_limits<double>::infinity();
  for (int j : {i - 1, i + 1}) {
    if (j < 0 || j >= static_cast<int>(pass.plan.intervals[s].size())) continue;
    const SoleError e = sole_error(pass.model.sole(side), sole, pass.plan.intervals[s][j].sole);
    depth = std::min(depth, e.penetration);
  }
  return std::isfinite(depth) ? depth : 0;
}

// Judged when all of it is known: foot_checks.cpp.
void note_soles(CheckPass& pass, int k) {
  for (Side side : {Side::left, Side::right}) {
    const ContactInterval& interval = pass.plan.at(side, k);
    const Isometry3d sole = sole_pose(pass.model, pass.dynamics.data(), side);
    SoleError& error = pass.soles[static_cast<int>(side)][k];
    if (interval.contact)
      error = sole_error(pass.model.sole(side), sole, interval.sole);
    else
      error.penetration = swing_depth(pass, side, k, sole);
  }
}

void check_position(CheckPass& pass, int k, int i) {
  const Dof& dof = pass.model.dofs()[i];
  if (!dof.limited) return;
  const double margin = pass.model.description().soft_limit_margin;
  const double theta = pass.series.samples[k].state.theta[i];
  const double lower = dof.lower + margin, upper = dof.upper - margin;
  const double half = 0.5 * (upper - lower);
  raise_to(pass.summary.max_joint_position_ratio,
           std::abs(theta - 0.5 * (lower + upper)) / std::max(half, 1e-9));
  const double beyond = std::max(lower - theta, theta - upper);
  if (beyond > pass.tolerance(FindingKind::joint_position))
    pass.add(FindingKind::joint_position, i, k, theta, theta > upper ? upper : lower, beyond);
}

void check_joint_rates(CheckPass& pass, int k, int i) {
  const CommandSample& s = pass.series.samples[k];
  const double limit = pass.limits.speed[i], speed = s.state.dtheta[i];
  if (std::isfinite(limit)) {
    const double ratio = std::abs(speed) / limit, most = pass.tolerance(FindingKind::joint_speed);
    raise_to(pass.summary.max_joint_speed_ratio, ratio);
    if (ratio > most) pass.add(FindingKind::joint_speed, i, k, speed, most * limit, ratio);
  }
  const double acceleration = s.acceleration[6 + i];
  raise_to(pass.summary.max_joint_acceleration, std::abs(acceleration));
  const double most = pass.tolerance(FindingKind::joint_acceleration);
  if (std::abs(acceleration) <= most) return;
  pass.rough[k] = true;
  pass.add(FindingKind::joint_acceleration, i, k, acceleration, most, std::abs(acceleration), 0,
           Severity::warning);
}

void check_torques(CheckPass& pass, int k, const VectorXd& torque) {
  for (int i = 0; i < pass.model.dof_count(); ++i) {
    const double limit = pass.limits.peak_torque[i];
    // A motor gives no more than its peak, so no more than that heats it.
    const double given = std::min(std::abs(torque[i]), limit);
    pass.square_sum(i, k + 1) = pass.square_sum(i, k) + given * given;
    if (!std::isfinite(limit)) continue;
    const double ratio = std::abs(torque[i]) / limit,
                 most = pass.tolerance(FindingKind::joint_torque);
    raise_to(pass.summary.max_torque_ratio, ratio);
    if (ratio > most) pass.add(FindingKind::joint_torque, i, k, torque[i], most * limit, ratio);
  }
}

void check_sample(CheckPass& pass, int k) {
  const SampleDynamics& motion = pass.dynamics.at(k);
  pass.cog[k] = pass.dynamics.data().cog;
  const Vector3d deviation = pass.cog[k] - pass.series.samples[k].cog;
  pass.cog_deviation[k] = deviation.norm();
  check_vector(pass, FindingKind::cog_residual, k, deviation, pass.summary.max_cog_residual);
  const bool known = !pass.at_flight_edge(k), flight = pass.dynamics.plane().empty();
  if (known) check_vertical_force(pass, k, flight ? 0 : motion.wrench[2]);
  if (known && flight) check_flight(pass, k, motion);
  if (known && !flight) check_ground(pass, k, motion);
  note_soles(pass, k);
  for (int i = 0; i < pass.model.dof_count(); ++i) {
    check_position(pass, k, i);
    check_joint_rates(pass, k, i);
  }
  check_torques(pass, k, known ? motion.torque : VectorXd::Zero(motion.torque.size()));
}

}  // namespace

void check_samples(CheckPass& pass) {
  for (int k = 0; k < pass.count(); ++k) check_sample(pass, k);
}

}  // namespace ayumi
