#pragma once
// Loads that a robot carries become part of its links.

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// The robot with point masses on its links, as a model of its own.
RobotModel with_payloads(const RobotModel& model, const std::vector<CarriedMass>& payloads);

}  // namespace ayumi
