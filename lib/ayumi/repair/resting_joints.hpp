#pragma once
// Joints that rest at the end of their range. A servo target leads its joint by the time L of the
// servo. Let u be the distance of the joint from the end of its range. Then the target stays within
// the range if u + L u' >= 0. So u falls at most like exp(-t/L), and a joint that a correction
// moves away from its end cannot rest there again. Such joints are no variables of a repair.

#include <vector>

#include "ayumi/limits/finding.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The windows of each dof [s] in which it rests at the end of the range of its servo targets.
/// Joints without lead and joints with an error in `errors` have none.
std::vector<std::vector<TimeWindow>> rests_at_limits(const RobotModel& model,
                                                     const CommandSeries& series,
                                                     const ActuatorLimits& actuators,
                                                     const std::vector<Finding>& errors);

}  // namespace ayumi
