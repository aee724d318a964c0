#pragma once
// Tests of causes: would a finding remain if its cause were removed? The same motion is evaluated
// again with one thing corrected.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Whether the bodies overlap by at most 15 mm, and would not overlap if every joint were within
/// its limits.
bool touches_by_limits(const JudgedMotion& motion, const Violation& collision);

/// Whether the distance of the bodies depends on this joint.
bool sets_distance(const JudgedMotion& motion, const Violation& collision, int dof);

/// As sets_distance(), but false for a joint outside the legs if one of the bodies is the trunk.
bool hangs_on(const JudgedMotion& motion, const Violation& collision, int dof);

/// Whether the torque of a flight is within its limit if no external force or moment acts on the
/// robot.
bool holds_in_free_flight(JudgedMotion& motion, const Violation& torque);

/// Whether the foot error explains the COG error. This is so if the COG error is at most the
/// displacement of the sole, or if it vanishes when the robot is moved rigidly so that the sole is
/// in its place. A swinging sole always explains it.
bool moves_cog(const JudgedMotion& motion, const Violation& foot, const Violation& cog);

/// Whether the ZMP is outside the support because the command puts it there, so that no posture is
/// the cause.
bool is_asked_for(JudgedMotion& motion, const Violation& v);

/// Whether a foot that does not count as supporting at this sample stands in the place of its
/// previous or of its next contact.
bool uncounted_foot_stands(const JudgedMotion& motion, int sample);

}  // namespace ayumi
