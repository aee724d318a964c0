#pragma once
// A position servo with damping follows its command late by kd/kp, so what it receives leads the
// posture by that time: command = theta + kd/kp dtheta. Here both ways.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Time by which a servo target must lead so that the joint does not lag: kd / kp of each joint
/// [s].
Eigen::VectorXd servo_lead(const RobotModel& model);

/// The table whose theta are postures: where they are what servos receive (`table.commands`), the
/// lead is taken out again, exactly for commands that are straight between rows; the first row
/// rests. Joints that the model does not have stay as they are.
DenseTable postures_of(const RobotModel& model, DenseTable table);

}  // namespace ayumi
