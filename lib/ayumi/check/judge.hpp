#pragma once
// The verdict on a pattern, the same in every command: the pattern is good if the motion is
// consistent and the actuators suffice for the motion and for the goals of VIIP. During such a
// goal, the motion only holds a posture.

#include "ayumi/check/actuator_need.hpp"

namespace ayumi {

struct Judgement {
  /// Report on the motion; its `consistent` is the verdict on motion and goals.
  ConsistencyReport report;
  /// Whether the motion itself has no errors. If it has some, they are errors that a repair can try
  /// to remove.
  bool motion_consistent = true;
  ActuatorNeed motion_need;  ///< what the profile lacks for the motion
  ActuatorNeed goal_need;    ///< what the profile lacks for the goals

  bool good() const { return report.consistent; }
  /// What the profile lacks for the motion or, if it suffices for the motion, for the goals.
  const ActuatorNeed& need() const { return motion_need.text.empty() ? goal_need : motion_need; }
  /// "the pattern is inconsistent: joint_torque of r_knee at 1.200 s: 5.2 N m, limit 4.5 N m (and 3
  /// more errors)"; empty when the pattern is good.
  std::string reason() const;
};

/// `goals` are the goals of the series in their keyed forms. Throws the same errors as
/// check_consistency(). `observe` sees the samples of the series.
Judgement judge(const RobotModel& model, const CommandSeries& series,
                const std::vector<KeyedGoal>& goals, const CheckOptions& options,
                const SampleObserver& observe = {});

}  // namespace ayumi
