#pragma once
// Rows of single joints: position, speed, acceleration and motor torque.

#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

bool is_of_joint(ConstraintGroup group);
/// Position, speed and acceleration, which depend on the joint's own column alone.
bool is_of_joint_angle(ConstraintGroup group);

Eigen::VectorXd joint_values(const ConstraintBlock& block, const PointState& state);
std::array<Eigen::MatrixXd, 3> joint_derivatives(const RobotModel& model,
                                                 const ConstraintBlock& block,
                                                 const PointState& state);

void place_joint_rows(RowPlacement& placement, int point);   ///< all but torques
void place_torque_rows(RowPlacement& placement, int point);  ///< where ground forces are known

}  // namespace ayumi
