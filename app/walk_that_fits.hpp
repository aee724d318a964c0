#pragma once
// What of a walk that was asked for the legs can do.

#include <string>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::app {

/// The side step or the turn that the legs can do, where they cannot do what was asked for; ""
/// where that is not what is wrong.
std::string what_fits(const RobotModel& model, const WalkParameters& asked);

}  // namespace ayumi::app
