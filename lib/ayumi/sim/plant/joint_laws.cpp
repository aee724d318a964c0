#include "ayumi/sim/plant/joint_laws.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

/// Joint rate up to which dry friction acts as a steep viscous friction, which is how it sticks
/// [rad/s, m/s]. Chosen: a joint under a load below its dry friction creeps by less than 0.06
/// deg/s. No measured case changes from half to twice (constants.md).
constexpr double kStickRate = 1e-3;

/// Stiffness and damping of an end stop, in those of the joint's servo. Chosen: a servo that pushes
/// against its stop with its full torque passes it by 1/20 of the servo's error. Figures change by
/// less than 5 % from half to twice.
constexpr double kStopStiffness = 20.0;

/// Penetration of a passive slide's end stop under the robot's weight, times kStopStiffness [m].
/// Chosen: the stop then yields by 0.05 mm. No measured case changes from half to twice
/// (constants.md).
constexpr double kStopSink = 0.001;

/// Damping over stiffness of a passive joint's end stop [s]. Chosen: 20 steps of 1 ms, so that the
/// joint does not bounce. No measured case changes from half to twice (constants.md).
constexpr double kStopDampingTime = 0.02;

}  // namespace

JointLaws::JointLaws(const RobotModel& model, const ActuatorLimits& limits)
    : limits_(limits),
      joints_(static_cast<size_t>(model.dof_count())),
      torque_(VectorXd::Zero(model.dof_count())) {
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[j];
    const ServoDescription& servo = dof.servo;
    if (servo.kp <= 0 && !model.description().servos.contains(dof.name))
      fail(ErrorCode::bad_model,
           model.name() + ": joint " + dof.name + " has no servo (kp); give it one in the sidecar");
    Joint& joint = joints_[static_cast<size_t>(j)];
    joint.own = {servo.kp, servo.kd, servo.viscous, servo.coulomb};
    joint.lower = dof.lower;
    joint.upper = dof.upper;
    joint.limited = dof.limited;
    // A joint without a motor has an end stop too; that of a hinge has 20 weights times 1 m/rad.
    const double weight = model.mass() * kGravity;
    const double passive = dof.prismatic ? weight / kStopSink : weight;
    joint.stop = kStopStiffness * (servo.kp > 0 ? servo.kp : passive);
    joint.stop_damping = servo.kp > 0 ? kStopStiffness * servo.kd : kStopDampingTime * joint.stop;
  }
}

void JointLaws::set(const VectorXd& targets, const std::vector<JointFault>& faults) {
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    joint.now = joint.own;
    joint.target = targets[static_cast<Eigen::Index>(j)];
    if (faults.empty()) continue;
    const JointFault& fault = faults[j];
    joint.now.kp *= fault.gain;
    joint.now.kd *= fault.gain;
    joint.now.viscous += fault.viscous;
    joint.now.coulomb += fault.coulomb;
    joint.target -= fault.encoder;
  }
}

// Within a solve a joint that has left its servo's law, or its sticking friction, does not return.
void JointLaws::start() {
  for (Joint& joint : joints_) joint.saturated = joint.sliding = false;
}

void JointLaws::add(const VectorXd& theta, const double* rate, double dt, double* impulse,
                    std::vector<double>& diagonal) const {
  for (size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    const Law& law = joint.now;
    const double angle = theta[static_cast<Eigen::Index>(j)];
    double sum = impulse[j], D = dt * law.viscous;
    if (joint.saturated) {
      sum += dt * joint.limit_torque;
    } else {
      D += dt * law.kd + dt * dt * law.kp;
      sum += dt * law.kp * (joint.target - angle);
    }
    if (law.coulomb > 0) {
      if (joint.sliding)
        sum += dt * joint.slip_torque;
      else
        D += dt * law.coulomb / kStickRate;
    }
    if (joint.beyond_range(angle)) {
      D += dt * dt * joint.stop + dt * joint.stop_damping;
      sum += dt * joint.stop * (std::clamp(angle, joint.lower, joint.upper) - angle);
    }
    impulse[j] = sum - D * rate[j];
    diagonal[j] = D;
  }
}

bool JointLaws::check(const VectorXd& theta, const double* rate, double dt) {
  bool changed = false;
  for (size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const Law& law = joint.now;
    const auto i = static_cast<Eigen::Index>(j);
    if (!joint.saturated) {
      double& torque = torque_[i];
      torque = law.kp * (joint.target - theta[i] - dt * rate[j]) - law.kd * rate[j];
      const double limit =
          available_torque(limits_, static_cast<int>(j), rate[j], torque > 0 ? 1.0 : -1.0);
      if (std::abs(torque) > limit) {
        joint.saturated = changed = true;
        joint.limit_torque = torque = std::copysign(limit, torque);
      }
    }
    if (law.coulomb > 0 && !joint.sliding && std::abs(rate[j]) > kStickRate) {
      joint.sliding = changed = true;
      joint.slip_torque = -std::copysign(law.coulomb, rate[j]);
    }
  }
  return changed;
}

void JointLaws::add_work(const VectorXd& theta, const double* before, const double* after,
                         double dt, EnergyBalance& work) const {
  for (size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    const Law& law = joint.now;
    const auto i = static_cast<Eigen::Index>(j);
    const double rate = after[j], mean = 0.5 * (before[j] + rate);
    work.servos += dt * torque_[i] * mean;
    double force = -law.viscous * rate;
    if (law.coulomb > 0)
      force += joint.sliding ? joint.slip_torque : -law.coulomb / kStickRate * rate;
    if (joint.beyond_range(theta[i]))
      force +=
          joint.stop * (std::clamp(theta[i], joint.lower, joint.upper) - theta[i] - dt * rate) -
          joint.stop_damping * rate;
    work.joints += dt * force * mean;
  }
}

}  // namespace ayumi
