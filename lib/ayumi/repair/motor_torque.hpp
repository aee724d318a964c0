#pragma once
// Motor torques of a corrected motion (motor_torques() of demand/ground_demand.hpp), and their
// derivatives by the correction's value, rate and acceleration.

#include "ayumi/repair/constraint_rows.hpp"

namespace ayumi {

/// Fills state.torque and, with `force_by`, state.torque_by. `force`: of inverse_dynamics(), which
/// left `data`; `force_by`: all its rows by value, rate and acceleration, or null. The wrench of
/// `state` must be set.
void fill_motor_torques(const RobotModel& model, const ActuatorLimits& actuators,
                        const CollocationPoint& point, const Eigen::VectorXd& force,
                        const std::array<Eigen::MatrixXd, 3>* force_by, const RobotData& data,
                        PointState& state);

}  // namespace ayumi
