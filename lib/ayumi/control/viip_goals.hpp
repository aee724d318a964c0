#pragma once
// Goals of VIIP as motions the check can judge, and the goals that a robot cannot reach at all.

#include <vector>

#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/keyed_goal.hpp"

namespace ayumi {

/// Of every goal of the series that moves the robot.
std::vector<KeyedGoal> keyed_goals(const RobotModel& model, const CommandSeries& series,
                                   const ControllerSpec& controller);

/// Throws Error(bad_pattern) naming the goal, the value and how much is possible, for a COG that
/// would leave the support of the feet or the reach of the legs, and for steps beyond the legs.
void require_reachable_goals(const RobotModel& model, const CommandSeries& series,
                             const ControllerSpec& controller);

}  // namespace ayumi
