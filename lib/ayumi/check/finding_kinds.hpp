#pragma once
// The tolerances that a check uses, and what the kinds of findings have in common.

#include "ayumi/check/consistency.hpp"

namespace ayumi {

/// Whether it is one of the posture itself, the same at whatever pace; a speed, a torque or a ZMP
/// can be mended at an instant though the posture there stays.
bool is_of_posture(const Finding& finding);

/// In the unit of each kind's FindingSpec.
using Tolerances = ByFindingKind<double>;

/// The defaults with the overrides. Throws Error(usage) for an unknown name or
/// a tolerance that is not a finite number.
Tolerances tolerances(const CheckOptions& options);

/// The same for a motion of one robot: what a moment in flight turns goes with weight times height,
/// so that its default limit is at least 0.65 % of that. A limit that was set stays as it is.
Tolerances tolerances(const CheckOptions& options, const RobotModel& model,
                      const CommandSeries& series);

}  // namespace ayumi
