#pragma once
// Robustness cost of a motion: the soft goals of a repair, evaluated on a motion. They are the
// ZMP's safe margin, soles that are closer to their places than the check asks for, swinging feet
// off the ground and low only over their places, bodies apart, joints within their limits, and DCM
// and ZMP near the plan.

#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The cost in the measure of weighted_change() [s], over the times at which `after` differs from
/// `before`, by the rows of the repair's own program: each limit's largest violation in a window of
/// time at its price. 0 for motions of different lengths. `options.safety` is a factor on all but
/// the places of the feet; `check` is the report of `before`.
double robustness_cost(const RobotModel& model, const CommandSeries& before,
                       const CommandSeries& after, const RepairOptions& options,
                       const ConsistencyReport& check);

}  // namespace ayumi
