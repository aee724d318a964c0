#pragma once
// What would be left of a finding without its cause: the same motion looked at again with one thing
// put right.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Bodies that meet by no more than 15 mm and would not with every joint within its limits.
bool touches_by_limits(const JudgedMotion& motion, const Violation& collision);

bool in_leg(const RobotModel& model, Side side, int dof);

/// Bodies whose distance this joint sets.
bool sets_distance(const JudgedMotion& motion, const Violation& collision, int dof);

/// The same, but not an arm and the trunk: that is a fact of its own.
bool hangs_on(const JudgedMotion& motion, const Violation& collision, int dof);

/// The torque of a flight is within its limit when nothing pushes or turns the robot.
bool holds_in_free_flight(JudgedMotion& motion, const Violation& torque);

/// A sole out of its place accounts for a COG off its command: the COG is no farther off than the
/// sole, or as good as commanded when the robot is put back with the sole into its place. Swinging
/// soles account for any.
bool moves_cog(const JudgedMotion& motion, const Violation& foot, const Violation& cog);

/// A ZMP outside the support because the command wants it there: no posture is to blame.
bool is_asked_for(JudgedMotion& motion, const Violation& v);

/// A foot that is not counted at this sample stands where it stood before or will stand after.
bool uncounted_foot_stands(const JudgedMotion& motion, int sample);

}  // namespace ayumi
