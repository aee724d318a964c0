#pragma once
// Rows that hold the corrected posture to something given: a trusted COG or ZMP, a locked posture,
// and the planned DCM. The DCM is a soft goal: minimum change alone would leave the DCM displaced
// where a posture is thrown off its plan, which costs push tolerance. The supports stay as planned,
// so that what a displaced DCM gains in one direction it loses in the opposite one. The ZMP is held
// with it, because a ZMP that holds the swing of a limb acts as a push on a controller that follows
// COG and feet.

#include <vector>

#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

/// Values of cog, pose and dcm rows, and their derivatives.
Eigen::VectorXd command_values(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& point, const PointState& state);
std::array<Eigen::MatrixXd, 3> command_derivatives(const RobotModel& model,
                                                   const ConstraintBlock& block,
                                                   const CollocationPoint& point,
                                                   const PointState& state);

/// By point: around where the posture has the DCM off a plan that is right. Where both agree and
/// the motion is at fault all the same, the DCM has to move.
std::vector<bool> where_dcm_is_held(const RowPlacement& placement);

void place_pose_rows(RowPlacement& placement, int point);     ///< where the posture is locked
void place_command_rows(RowPlacement& placement, int point);  ///< of a trusted COG or ZMP
void place_dcm_rows(RowPlacement& placement, int point);

}  // namespace ayumi
