#pragma once
// What the servos must be told before anything is measured. A position servo gives torque only
// where it is off its target, kp (target - theta) + kd (dtarget - dtheta) = tau at best, so that a
// posture sent as it is sags under the weight by tau / kp and follows late by kd / kp.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// dof x samples [rad]: tau / kp, by which a target must lie beyond the posture so that the joint
/// does not sag, with tau of the planned motion on its planned contacts (as the check has it), at
/// most what the motor gives at `limits`. Zero for joints without a motor.
Eigen::MatrixXd servo_sag(const RobotModel& model, const ActuatorLimits& limits,
                          const CommandSeries& series);

}  // namespace ayumi
