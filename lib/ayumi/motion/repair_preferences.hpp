#pragma once
// What the author wants of a repair, against the robot and the motion it is about.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Throws Error(bad_pattern) "file: repair/...: ..." for joints the robot has not and windows that
/// begin after the motion has ended.
void require_repair_wishes(const RobotModel& model, const Pattern& pattern);

/// Locked keyframes as windows at their times, for a pattern that is to lose its keys.
RepairWishes without_keyframes(const Pattern& pattern);

}  // namespace ayumi
