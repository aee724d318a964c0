#pragma once
// Flight: nothing can turn the robot, so the trunk turns as the legs make it. Zero angular momentum
// about the COG fixes the trunk's rate at every instant, lift-off and touchdown included; before
// and after the trunk swings smoothly from and to the attitude the pattern asks for.

#include <array>
#include <functional>

#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

/// The planned COG at a time: position [m], rate, acceleration by axis.
using CogAt = std::function<std::array<TrackPoint, 3>(double)>;

/// Zero for patterns without flight or with torso keys.
/// Throws Error(bad_pattern) where the legs cannot follow.
TrunkTurn plan_trunk_turn(const SampleJob& job, const CogAt& cog);

}  // namespace ayumi
