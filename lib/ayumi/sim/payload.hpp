#pragma once
// Makes the loads that a robot carries part of its links.

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// A model of the robot with point masses on its links.
RobotModel with_payloads(const RobotModel& model, const std::vector<CarriedMass>& payloads);

}  // namespace ayumi
