#pragma once
// Tests of causes: would a finding remain if its cause were removed? The same motion is evaluated
// again with one thing corrected.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// The bodies overlap by at most 15 mm, and not at all if every joint is within its limits.
bool touches_by_limits(const JudgedMotion& motion, const Violation& collision);

bool in_leg(const RobotModel& model, Side side, int dof);

/// The distance of the bodies depends on this joint.
bool sets_distance(const JudgedMotion& motion, const Violation& collision, int dof);

/// The distance depends on this joint, and the bodies are not an arm and the trunk.
bool hangs_on(const JudgedMotion& motion, const Violation& collision, int dof);

/// The torque of a flight is within its limit when nothing pushes or turns the robot.
bool holds_in_free_flight(JudgedMotion& motion, const Violation& torque);

/// Whether the COG error is explained by the foot error: the COG is no farther off than the sole,
/// or its error vanishes when the robot is moved back rigidly with the sole into its place.
/// Swinging soles always explain it.
bool moves_cog(const JudgedMotion& motion, const Violation& foot, const Violation& cog);

/// The ZMP is outside the support because the command puts it there, so no posture is the cause.
bool is_asked_for(JudgedMotion& motion, const Violation& v);

/// A foot that is not counted at this sample stands where it stood before or will stand after.
bool uncounted_foot_stands(const JudgedMotion& motion, int sample);

}  // namespace ayumi
