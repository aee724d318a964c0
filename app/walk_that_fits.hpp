#pragma once
// Finds which part of a requested walk the legs can do.

#include <string>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::app {

/// The side step or the turn that the legs can do, if they cannot do the requested one; "" if the
/// cause is something else.
std::string what_fits(const RobotModel& model, const WalkParameters& asked);

}  // namespace ayumi::app
