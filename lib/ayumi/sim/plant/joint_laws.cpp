#include "ayumi/sim/plant/joint_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

/// Largest number of times that a servo changes to another piece of the torque's bound in one
/// solve. Chosen: the bound has four pieces, so three are left after the first; the first is right
/// unless the rate crosses a corner of the bound within the step.
constexpr int kBoundChanges = 3;

/// Joint rate up to which dry friction acts as a steep viscous friction [rad/s, m/s]. In this way,
/// it sticks. Chosen: a joint under a load below its dry friction creeps by less than 0.06 deg/s.
/// No measured case changes between half and twice the value (constants.md).
constexpr double kStickRate = 1e-3;

/// Stiffness and damping of an end stop, as multiples of those of the joint's servo. Chosen: a
/// servo that pushes against its stop with its full torque passes it by 1/20 of the servo's error.
/// Between half and twice the value, figures change by less than 5 %.
constexpr double kStopStiffness = 20.0;

/// Penetration of a passive sliding joint's end stop under the robot's weight, times kStopStiffness
/// [m]. Chosen: the stop then yields by 0.05 mm. No measured case changes between half and twice
/// the value (constants.md).
constexpr double kStopSink = 0.001;

/// Ratio of damping to stiffness of a passive joint's end stop [s]. Chosen: 20 steps of 1 ms, so
/// that the joint does not bounce. No measured case changes between half and twice the value
/// (constants.md).
constexpr double kStopDampingTime = 0.02;

}  // namespace

JointLaws::JointLaws(const RobotModel& model, const ActuatorLimits& limits)
    : limits_(limits),
      model_(&model),
      delay_(limits.servo),
      joints_(static_cast<size_t>(model.dof_count())),
      torque_(VectorXd::Zero(model.dof_count())) {
  for (size_t j = 0; j < joints_.size(); ++j) {
    const Dof& dof = model.dofs()[j];
    const ServoDescription& servo = limits.servo[j];
    if (servo.kp <= 0 && !limits.has_servo[j])
      fail(ErrorCode::bad_model, model.name() + ": joint " + dof.name +
                                     " has no servo. State kp of this joint in the sidecar");
    Joint& joint = joints_[j];
    joint.lower = dof.lower;
    joint.upper = dof.upper;
    joint.limited = dof.limited;
    joint.has_gear = servo.has_gear() && servo.kp > 0;
    if (joint.has_gear) {
      joint.gear = gear_stiffness(servo);
      joint.gear_damping = gear_damping(servo);
      joint.rotor = servo.rotor_inertia;
      joint.half_play = 0.5 * servo.backlash;
    }
    joint.plain_error = !servo.quantized && servo.dead_band <= 0;
    joint.offset = servo.offset;
    joint.most = limits.peak_torque[static_cast<Eigen::Index>(j)];
    const double speed = limits.speed[static_cast<Eigen::Index>(j)];
    joint.fastest = std::isfinite(speed) ? speed : std::numeric_limits<double>::infinity();
    joint.stall = servo.stall_torque;
    joint.back_emf = servo.back_emf;
    joint.speed_command = servo.speed_command_limit;
    joint.needs_friction = servo.stribeck_rate > 0 || !(servo.load == LoadFriction{});
    // A joint without a motor also has an end stop. The stop of a hinge has the stiffness
    // kStopStiffness times the weight of the robot times 1 m/rad.
    const double weight = model.mass() * kGravity;
    const double passive = dof.prismatic ? weight / kStopSink : weight;
    joint.stop = kStopStiffness * (servo.kp > 0 ? servo.kp : passive);
    joint.stop_damping = servo.kp > 0 ? kStopStiffness * servo.kd : kStopDampingTime * joint.stop;
  }
}

void JointLaws::reset(const RobotState& state) {
  delay_.reset();
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const auto i = static_cast<Eigen::Index>(j);
    joint.phi = state.theta[i];
    joint.dphi = joint.last_rate = state.dtheta[i];
    joint.external = joint.last_torque = 0;
  }
}

void JointLaws::set(const VectorXd& targets, const std::vector<JointFault>& faults,
                    const VectorXd& theta, double dt) {
  const VectorXd& delayed = delay_.step(targets, dt);
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const ServoDescription& servo = limits_.servo[j];
    const auto i = static_cast<Eigen::Index>(j);
    static const JointFault kNone;
    const JointFault& fault = faults.empty() ? kNone : faults[j];
    joint.kp = servo.kp * fault.gain;
    joint.kd = servo.kd * fault.gain;
    joint.viscous = servo.viscous + fault.viscous;
    joint.coulomb = fault.coulomb +
                    (joint.needs_friction
                         ? dry_friction(servo, joint.last_rate, joint.last_torque, joint.external)
                         : servo.coulomb);
    if (joint.plain_error) {
      joint.target = delayed[i] - fault.encoder + joint.offset;
      joint.inside_band = false;
      continue;
    }
    const ServoError error = servo_error(servo, model_->dofs()[j], delayed[i] - fault.encoder,
                                         joint.has_gear ? joint.phi : theta[i]);
    joint.target = error.target;
    joint.inside_band = error.inside;
  }
}

// A motor that moves is expected to continue sliding. Within a solve, a joint that has left its
// servo's law or the flank of its gear does not return to it, and friction that was expected to
// slide sticks at most once.
void JointLaws::start(const VectorXd& theta, const double* rate, double dt) {
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    joint.saturated = joint.speed_bound = joint.gear_changed = joint.stuck = false;
    joint.bound_changes = 0;
    const double motor = joint.has_gear ? joint.dphi : rate[j];
    joint.sliding = joint.coulomb > 0 && std::abs(motor) > kStickRate;
    if (joint.sliding) joint.slip_torque = -std::copysign(joint.coulomb, motor);
    if (!joint.has_gear) continue;
    const double play =
        joint.phi - theta[static_cast<Eigen::Index>(j)] + dt * (joint.dphi - rate[j]);
    joint.flank = play >= joint.half_play    ? Flank::high
                  : play <= -joint.half_play ? Flank::low
                                             : Flank::none;
  }
}

JointLaws::Impulse JointLaws::motor_impulse(const Joint& joint, double phi, double dt) const {
  Impulse out{0, dt * joint.viscous};
  if (joint.saturated) {
    out.sum = dt * joint.direction * joint.bound.torque;
    out.damping += dt * joint.bound.slope;
  } else if (joint.speed_bound || joint.inside_band) {
    out.sum = joint.speed_bound ? dt * joint.speed_torque : 0;
    out.damping += dt * joint.kd;
  } else {
    out.sum = dt * joint.kp * (joint.target - phi);
    out.damping += dt * joint.kd + dt * dt * joint.kp;
  }
  if (joint.coulomb > 0) {
    if (joint.sliding)
      out.sum += dt * joint.slip_torque;
    else
      out.damping += dt * joint.coulomb / kStickRate;
  }
  return out;
}

// The motor behind a gear obeys rotor (dphi+ - dphi) = motor's impulse - gear's impulse. Solved for
// dphi+, the gear's impulse on the joint only depends on dtheta+.
void JointLaws::solve_motor(Joint& joint, double theta, double dt, Impulse& on_joint) const {
  const Impulse motor = motor_impulse(joint, joint.phi, dt);
  joint.mesh = joint.slope = 0;
  if (joint.flank != Flank::none) {
    const double edge = joint.flank == Flank::high ? joint.half_play : -joint.half_play;
    joint.mesh = dt * joint.gear * (joint.phi - theta - edge);
    joint.slope = dt * dt * joint.gear + dt * joint.gear_damping;
  }
  joint.momentum = joint.rotor * joint.dphi + motor.sum - joint.mesh;
  joint.inertia = joint.rotor + motor.damping + joint.slope;
  if (joint.slope <= 0) return;
  const double share = joint.slope / joint.inertia;
  on_joint.sum += joint.mesh + share * joint.momentum;
  on_joint.damping += joint.slope * (1 - share);
}

double JointLaws::motor_rate(const Joint& joint, double rate) {
  if (!joint.has_gear) return rate;
  return joint.inertia > 0 ? (joint.momentum + joint.slope * rate) / joint.inertia : joint.dphi;
}

void JointLaws::add(const VectorXd& theta, const double* rate, double dt, double* impulse,
                    std::vector<double>& diagonal) {
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const double angle = theta[static_cast<Eigen::Index>(j)];
    Impulse out;
    if (joint.has_gear)
      solve_motor(joint, angle, dt, out);
    else
      out = motor_impulse(joint, angle, dt);
    if (joint.beyond_range(angle)) {
      out.damping += dt * dt * joint.stop + dt * joint.stop_damping;
      out.sum += dt * joint.stop * (std::clamp(angle, joint.lower, joint.upper) - angle);
    }
    impulse[j] = impulse[j] + out.sum - out.damping * rate[j];
    diagonal[j] = out.damping;
  }
}

// A servo that passes the bound of its torque first follows the piece of the bound at the rate
// before the step, and then the piece at the solved rate. The rate that the servo's own law gives
// cannot be used: far from the target, no motor reaches this rate, and the bound there is zero.
bool JointLaws::check_bound(Joint& joint, size_t j, double dphi) {
  torque_[static_cast<Eigen::Index>(j)] =
      joint.direction * joint.bound.torque - joint.bound.slope * dphi;
  if (joint.bound_changes == kBoundChanges) return false;
  const TorqueBound bound = torque_bound(limits_, static_cast<int>(j), dphi, joint.direction);
  if (bound.piece == joint.bound.piece) return false;
  ++joint.bound_changes;
  joint.bound = bound;
  return true;
}

/// Whether torque_range() at this rate certainly contains the torque: neither a speed limit nor a
/// voltage bends the bound there. This is so for most servos in most steps.
bool JointLaws::far_from_bounds(const Joint& joint, double torque, double dphi) {
  if (!(std::abs(torque) <= joint.most && std::abs(dphi) <= joint.fastest)) return false;
  if (joint.stall <= 0) return true;
  const double lost = joint.back_emf * dphi;
  return torque <= joint.stall - lost && -torque <= joint.stall + lost;
}

bool JointLaws::check_servo(Joint& joint, size_t j, double phi, double dphi, double dt) {
  double& torque = torque_[static_cast<Eigen::Index>(j)];
  if (joint.saturated) return check_bound(joint, j, dphi);
  const double error = joint.target - phi - dt * dphi;
  const double most = joint.kd * joint.speed_command;
  if (most > 0 && !joint.speed_bound && !joint.inside_band && std::abs(joint.kp * error) > most) {
    joint.speed_bound = true;
    joint.speed_torque = std::copysign(most, error);
    return true;
  }
  torque = joint.speed_bound ? joint.speed_torque : joint.inside_band ? 0 : joint.kp * error;
  torque -= joint.kd * dphi;
  if (far_from_bounds(joint, torque, dphi)) return false;
  const TorqueRange range = torque_range(limits_, static_cast<int>(j), dphi);
  if (torque >= range.low && torque <= range.high) return false;
  joint.saturated = true;
  joint.direction = torque > range.high ? 1.0 : -1.0;
  joint.bound = torque_bound(limits_, static_cast<int>(j), joint.last_rate, joint.direction);
  torque = joint.direction * joint.bound.torque - joint.bound.slope * dphi;
  return true;
}

bool JointLaws::check_gear(Joint& joint, double theta, double rate, double dphi, double dt) {
  if (!joint.has_gear || joint.half_play <= 0 || joint.gear_changed) return false;
  const Flank before = joint.flank;
  const double impulse = joint.mesh + joint.slope * (dphi - rate);
  const double play = joint.phi - theta + dt * (dphi - rate);
  if (joint.flank == Flank::none)
    joint.flank = play > joint.half_play    ? Flank::high
                  : play < -joint.half_play ? Flank::low
                                            : Flank::none;
  else if (joint.flank == Flank::high ? impulse < 0 : impulse > 0)
    joint.flank = Flank::none;  // teeth can push, but cannot pull
  return joint.gear_changed = joint.flank != before;
}

// Friction that would drive the motor sticks instead.
bool JointLaws::check_friction(Joint& joint, double dphi) {
  if (joint.coulomb <= 0) return false;
  if (joint.sliding && joint.slip_torque * dphi > 0 && !joint.stuck) {
    joint.stuck = true;
    joint.sliding = false;
    return true;
  }
  if (joint.sliding || std::abs(dphi) <= kStickRate) return false;
  joint.sliding = true;
  joint.slip_torque = -std::copysign(joint.coulomb, dphi);
  return true;
}

// A joint only changes one law at a time: if a motor was wrongly assumed to stick, its rate says
// nothing about its servo, and the rate of a servo beyond its limits says nothing about its gear.
bool JointLaws::check(const VectorXd& theta, const double* rate, double dt) {
  bool changed = false;
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const double angle = theta[static_cast<Eigen::Index>(j)];
    const double dphi = motor_rate(joint, rate[j]);
    changed |= check_friction(joint, dphi) ||
               check_servo(joint, j, joint.has_gear ? joint.phi : angle, dphi, dt) ||
               check_gear(joint, angle, rate[j], dphi, dt);
  }
  return changed;
}

double JointLaws::friction(const Joint& joint, double dphi) {
  double torque = -joint.viscous * dphi;
  if (joint.coulomb > 0)
    torque += joint.sliding ? joint.slip_torque : -joint.coulomb / kStickRate * dphi;
  return torque;
}

void JointLaws::advance(const VectorXd& theta, const double* before, const double* after, double dt,
                        EnergyBalance& work) {
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const auto i = static_cast<Eigen::Index>(j);
    const double rate = after[j], mean = 0.5 * (before[j] + rate);
    const double dphi = motor_rate(joint, rate);
    const double motor_mean = joint.has_gear ? 0.5 * (joint.dphi + dphi) : mean;
    const double drag = friction(joint, dphi);
    work.servos += dt * torque_[i] * motor_mean;
    double force = 0;
    if (joint.beyond_range(theta[i]))
      force +=
          joint.stop * (std::clamp(theta[i], joint.lower, joint.upper) - theta[i] - dt * rate) -
          joint.stop_damping * rate;
    work.joints += dt * (force * mean + drag * motor_mean);
    joint.last_rate = dphi;
    joint.last_torque = torque_[i];
    if (joint.has_gear) {
      const double mesh = joint.mesh + joint.slope * (dphi - rate);
      work.joints += mesh * (mean - motor_mean);
      joint.external = -mesh / dt;
      joint.phi += dt * dphi;
      joint.dphi = dphi;
    } else {
      const double rotor = limits_.servo[j].rotor_inertia;
      joint.external = rotor * (rate - before[j]) / dt - torque_[i] - drag;
    }
  }
}

void JointLaws::motors(const VectorXd& theta, const VectorXd& rate, VectorXd& angle,
                       VectorXd& motor_rate) const {
  angle = theta;
  motor_rate = rate;
  for (size_t j = 0; j < joints_.size(); ++j) {
    if (!joints_[j].has_gear) continue;
    angle[static_cast<Eigen::Index>(j)] = joints_[j].phi;
    motor_rate[static_cast<Eigen::Index>(j)] = joints_[j].dphi;
  }
}

}  // namespace ayumi
