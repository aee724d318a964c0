#pragma once
// Bounds of servo constants that follow from the robot itself. The reader of a robot's file only
// tests bounds that are valid for every robot. The constants of a small servo in a wrong unit may
// be within these bounds. Constants that no motor of a robot of this mass and size can have are
// refused here.

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Twice the longest path from the root along the joints to a body's centre of mass [m].
double stretched_length(const RobotModel& model);

/// Throws Error(bad_model) "file: profile, joint: value, limit" for the first constant that is too
/// large for the robot.
void require_servos_that_fit(const RobotModel& model);

}  // namespace ayumi
