#pragma once
// What a joint's motor can give.

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Largest torque [N m] towards `direction` (+1, -1) at the given joint rate [rad/s]: a motor
/// cannot push a joint beyond its speed limit, so it fades over the tenth beyond that limit.
double available_torque(const ActuatorLimits& limits, int dof, double rate, double direction);

}  // namespace ayumi
