#pragma once
// Which actuators a motion needs: where those of a profile are not enough, how much is missing and
// which profiles of the robot would do.

#include "ayumi/check/consistency.hpp"
#include "ayumi/motion/keyed_goal.hpp"

namespace ayumi {

struct ActuatorNeed {
  std::string text;                     ///< in words; empty when the profile is enough
  std::vector<std::string> sufficient;  ///< other profiles that are enough
};

/// For `report`, the check of `series` with `options`; looks at joint speed, torque and steps only.
ActuatorNeed actuator_need(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options, const ConsistencyReport& report);

/// For the goals of VIIP, which a series only holds still for: what the first of them needs whose
/// keyed form the profile of `options` cannot carry out, or why there is none.
ActuatorNeed actuator_need(const RobotModel& model, const std::vector<KeyedGoal>& goals,
                           const CheckOptions& options);

}  // namespace ayumi
