#pragma once
// Which actuators a motion needs: where those of a profile are not enough, how much is missing and
// which profiles of the robot would do.

#include "ayumi/check/consistency.hpp"

namespace ayumi {

struct ActuatorNeed {
  std::string text;                     ///< in words; empty when the profile is enough
  std::vector<std::string> sufficient;  ///< other profiles that are enough
};

/// For `report`, the check of `series` with `options`; looks at joint speed, torque and steps only.
/// A phase with a VIIP jump goal is judged by the keyed jump of that height and stoop.
ActuatorNeed actuator_need(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options, const ConsistencyReport& report);

}  // namespace ayumi
