#pragma once
// Motor torques of a corrected motion (motor_torques of check/residuals.hpp), and how they change
// with the correction's value, rate and acceleration.

#include "ayumi/repair/correction_constraints.hpp"

namespace ayumi {

/// Needs the wrench of `state`, and `data` as inverse_dynamics left it for `force`. Fills
/// state.torque; with `force_by` (whole rows of inverse_dynamics by value, rate, acceleration) also
/// state.torque_by.
void fill_motor_torques(const RobotModel& model, const CollocationPoint& instant,
                        const Eigen::VectorXd& force,
                        const std::array<Eigen::MatrixXd, 3>* force_by, const RobotData& data,
                        PointState& state);

}  // namespace ayumi
