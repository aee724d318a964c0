#pragma once
// Motor torques of a corrected motion (motor_torques() of demand/ground_demand.hpp), and their
// derivatives by the correction's value, rate and acceleration.

#include "ayumi/repair/constraint_rows.hpp"

namespace ayumi {

/// Fills state.torque. The force, the wrench and the positions of `state` must already be set.
void fill_motor_torques(const RobotModel& model, const ActuatorLimits& actuators,
                        const CollocationPoint& point, PointState& state);

/// Fills state.torque_by. `force_by` contains the derivatives of inverse_dynamics() by the
/// correction. The derivatives of the wrench must be set.
void fill_motor_torque_derivatives(const RobotModel& model, const ActuatorLimits& actuators,
                                   const CollocationPoint& point,
                                   const InverseDynamicsDerivatives& force_by, PointState& state);

}  // namespace ayumi
