#pragma once
// The torque that a joint's motor can give.

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Largest torque [N m, N] in `direction` (+1 or -1) at the given joint rate [rad/s, m/s]. A motor
/// cannot push a joint beyond its speed limit: the torque falls linearly to 0 from the speed limit
/// to 1.1 times the speed limit.
double available_torque(const ActuatorLimits& limits, int dof, double rate, double direction);

}  // namespace ayumi
