#pragma once
// In flight, no external moment acts on the robot, so the trunk turns against the legs. Zero
// angular momentum about the COG determines the trunk's rate at each time of the flight, ends
// included. Before and after the flight the trunk swings smoothly from and to the commanded
// attitude.

#include <array>
#include <functional>

#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

/// The planned COG in the world at a time, by axis: position [m], rate [m/s], acceleration [m/s^2].
using CogAt = std::function<std::array<TrackPoint, 3>(double)>;

/// The turn of the trunk; zero for patterns without flight or with torso keys. Throws
/// Error(bad_pattern) where the legs cannot follow.
TrunkTurn plan_trunk_turn(const SampleJob& job, const CogAt& cog);

}  // namespace ayumi
