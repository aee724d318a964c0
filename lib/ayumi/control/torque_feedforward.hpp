#pragma once
// The torque part of the servo targets, which is known before anything is measured. It is added to
// the velocity feedforward of motion/servo_feedforward. A position servo only gives torque if the
// joint is off its target: kp (target - theta) + kd (dtarget - dtheta) = tau at best. So a posture
// that is sent unchanged sags under the weight by tau / kp.

#include <algorithm>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The angle tau / kp by which a target must be ahead of the posture so that the joint does not sag
/// [rad], as a matrix of dof x (samples + 1). tau is the torque of the planned motion on its
/// planned contacts, which is the torque that the check judges. It is limited to the torque that
/// the motor can give by `limits`. The last column is for the last posture at rest. The angle is
/// zero for joints without a motor.
Eigen::MatrixXd torque_feedforward(const RobotModel& model, const ActuatorLimits& limits,
                                   const CommandSeries& series);

/// The column of sample k. After the last sample, the last column.
inline auto lead_at(const Eigen::MatrixXd& torque_lead, long k) {
  return torque_lead.col(std::min<Eigen::Index>(k, torque_lead.cols() - 1));
}

}  // namespace ayumi
