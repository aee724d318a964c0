#pragma once
// Makes motions from goals of VIIP, so that the check can judge them, and refuses goals that a
// robot cannot reach at all.

#include <vector>

#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/keyed_goal.hpp"

namespace ayumi {

/// Equivalent motions of all goals of the series that move the robot.
std::vector<KeyedGoal> keyed_goals(const RobotModel& model, const CommandSeries& series,
                                   const ControllerSpec& controller);

/// Throws Error(bad_pattern) naming the goal, the value and how much is possible, for a COG that
/// would leave the support of the feet or the reach of the legs, and for steps that are too long
/// for the legs.
void require_reachable_goals(const RobotModel& model, const CommandSeries& series,
                             const ControllerSpec& controller);

}  // namespace ayumi
