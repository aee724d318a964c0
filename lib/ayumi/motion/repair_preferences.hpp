#pragma once
// The author's preferences for a repair, checked against the robot and the motion.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Throws Error(bad_pattern) "file: repair/...: ..." for joints that the robot does not have and
/// for windows that begin after the end of the motion.
void require_repair_preferences(const RobotModel& model, const Pattern& pattern);

/// The preferences for a pattern without keys, in which locked keyframes have become windows at
/// their times.
RepairPreferences without_keyframes(const Pattern& pattern);

}  // namespace ayumi
