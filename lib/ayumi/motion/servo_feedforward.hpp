#pragma once
// A position servo with damping follows its target with a delay of kd/kp. The target therefore
// leads the posture by that time: target = theta + kd/kp dtheta. These functions convert both ways.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Time by which a servo target has to lead so that the joint does not lag: kd / kp of each joint
/// [s].
Eigen::VectorXd velocity_lead(const RobotModel& model);

/// The table with postures as theta. Where they are servo targets (`table.commands`), the lead is
/// removed, exactly for targets that are linear between rows and rest at the first row. Joints that
/// the model does not have keep their values.
DenseTable postures_of(const RobotModel& model, DenseTable table);

}  // namespace ayumi
