#pragma once
// What a robot carries, made part of its links.

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// The robot with point masses on its links: another robot to the dynamics.
RobotModel with_payloads(const RobotModel& model, const std::vector<CarriedMass>& payloads);

}  // namespace ayumi
