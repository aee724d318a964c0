#pragma once
// The border between Ayumi and one robot unit. Inside, every angle is the angle of a joint. A robot
// receives, and reports, the angles that its encoders read. Every table and recording of a robot
// passes this border, and so do the targets and the readings of a simulated robot.

#include <Eigen/Core>
#include <string>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// The side of the border on which angles were measured. `encoder`: readings of the encoders of
/// this unit. `joint`: angles from instruments at the joints, which the zeros of the encoders do
/// not affect.
enum class MeasuredAt { encoder, joint };

/// "encoder" or "joint"; throws Error(usage) for another name.
MeasuredAt measured_at(const std::string& name);

/// The zeros of the encoders of this unit: the angle at which each joint stands while its encoder
/// reads 0 [rad, m], by dof. They belong to the unit, so they are the same in all its profiles.
Eigen::VectorXd encoder_zeros(const RobotModel& model);

/// Converts joint angles to the angles that the encoders read, and back [rad, m]. If `zeros` is
/// empty or contains only 0, the result has the same bits as the argument.
Eigen::VectorXd encoder_angles(const Eigen::VectorXd& joints, const Eigen::VectorXd& zeros);
Eigen::VectorXd joint_angles(const Eigen::VectorXd& encoders, const Eigen::VectorXd& zeros);

/// The same for tables with one row for each time.
Eigen::MatrixXd encoder_rows(Eigen::MatrixXd joints, const Eigen::VectorXd& zeros);
Eigen::MatrixXd joint_rows(Eigen::MatrixXd encoders, const Eigen::VectorXd& zeros);

}  // namespace ayumi
