#pragma once
// The clearance between the robot's own bodies along a motion.

#include <functional>

#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Calls note(pair, sample, clearance) for every pair of `collisions`, in order of time within a
/// pair. It does so every 20 ms, and at every sample around two kinds of times: those at which the
/// clearance of a pair has a minimum below `near` [m], and those at which the pair begins or ends
/// to overlap. Clearances [m] that are neither below `exact` [m] nor the smallest of all pairs are
/// lower bounds.
void scan_clearance(const RobotModel& model, const CommandSeries& series,
                    const CollisionModel& collisions, double near, double exact,
                    const std::function<void(int pair, int sample, double clearance)>& note);

}  // namespace ayumi
