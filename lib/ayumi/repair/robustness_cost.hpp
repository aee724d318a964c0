#pragma once
// Robustness cost of a motion: the soft goals of a repair, evaluated on a motion. They are: the ZMP
// has its safe margin, soles are closer to their places than the check requires, swinging feet are
// off the ground and are only low over their places, bodies are apart, joints are within their
// limits, and DCM and ZMP are near the plan.

#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The cost in the measure of weighted_change() [s], over the times at which `after` differs from
/// `before`. It uses the rows of the repair's own program: the largest violation of each limit in a
/// window of time is multiplied by its price. It is 0 for motions of different lengths.
/// `options.safety` is a factor on all prices except those of the places of the feet. `check` is
/// the report of `before`.
double robustness_cost(const RobotModel& model, const CommandSeries& before,
                       const CommandSeries& after, const RepairOptions& options,
                       const ConsistencyReport& check);

}  // namespace ayumi
