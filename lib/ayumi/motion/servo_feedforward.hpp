#pragma once
// A position servo follows its target late, by its transport delay and by kd/kp of its loop. The
// target therefore leads the posture by that time: target = theta + (delay + kd/kp) dtheta. These
// functions convert in both directions.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Time by which a servo target has to lead so that the joint does not lag: delay + kd / kp of each
/// joint [s]. It is 0 for a joint without a servo.
Eigen::VectorXd velocity_lead(const ActuatorLimits& actuators);

/// The table with postures as theta. If they are servo targets (`table.commands`), the lead is
/// removed, which is exact for targets that are linear between rows and rest at the first row.
/// Joints that the model does not have keep their values.
DenseTable postures_of(const RobotModel& model, const ActuatorLimits& actuators, DenseTable table);

/// The targets that lead the posture of a sample by the time `lead` [s], one entry per dof.
Eigen::VectorXd leading_target(const CommandSample& sample, const Eigen::VectorXd& lead);

/// The targets that lead the postures of a series by the time `lead` [s], one entry per dof. Each
/// sample gives one row.
ReferenceTrajectory leading_targets(const RobotModel& model, const CommandSeries& series,
                                    const Eigen::VectorXd& lead);

}  // namespace ayumi
