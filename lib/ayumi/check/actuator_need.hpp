#pragma once
// Which actuators a motion needs. If the actuators of a profile are too weak, the result says what
// the motion needs and which profiles of the robot are strong enough.

#include "ayumi/check/consistency.hpp"
#include "ayumi/motion/keyed_goal.hpp"

namespace ayumi {

struct ActuatorNeed {
  std::string text;                     ///< the need in words; empty if the profile is enough
  std::vector<std::string> sufficient;  ///< other profiles that are enough
  /// If joints of the legs are too fast because of a flight, the longest flight that one of them
  /// allows in the same postures, in words; else empty.
  std::string flight = {};
};

/// The need that follows from `report`, the check of `series` with `options`. Only joint speed,
/// torque and steps are considered.
ActuatorNeed actuator_need(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options, const ConsistencyReport& report);

/// The need that follows from the goals of VIIP, during which a series only holds a posture. It is
/// the need of the first goal whose keyed form is too much for the profile of `options`, or the
/// reason why a goal has no keyed form.
ActuatorNeed actuator_need(const RobotModel& model, const std::vector<KeyedGoal>& goals,
                           const CheckOptions& options);

}  // namespace ayumi
