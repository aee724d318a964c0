#pragma once
// Functions that the studies of many runs share.

#include "ayumi/base/in_parallel.hpp"
#include "ayumi/sim/simulator.hpp"

namespace ayumi {

/// Time of the push on the standing robot [s]. Chosen: the robot rests by then. No measured case
/// changes between half and twice the value (constants.md).
inline constexpr double kStandingPush = 0.5;
/// Time for which the series stands after this push [s]. Chosen: longer than the robot takes to
/// come to rest. No measured case changes between half and twice the value (constants.md).
inline constexpr double kStandingAfter = 2.5;

/// A series in which the robot holds the first posture of the pattern, under VIIP if the pattern
/// has goals.
CommandSeries standing_series(const CommandSeries& series);

/// The distance of the estimated DCM x + dx/omega of the last tick from the planned one [m].
double divergence(const Simulator& run);

}  // namespace ayumi
