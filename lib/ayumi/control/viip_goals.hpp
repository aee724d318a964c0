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

/// Throws Error(bad_pattern), which names the goal, the value and the largest possible value, if
/// the COG would leave the support of the feet or the reach of the legs, or if steps are too long
/// for the legs.
void require_reachable_goals(const RobotModel& model, const CommandSeries& series,
                             const ControllerSpec& controller);

}  // namespace ayumi
