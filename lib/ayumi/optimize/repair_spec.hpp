#pragma once
// What a repair is asked for, as its programs need it.

#include "ayumi/optimize/correction_problem.hpp"
#include "ayumi/optimize/repair.hpp"

namespace ayumi {

/// Of the first round, without collisions. Throws Error(usage) for joints the robot has not,
/// weights that are not above 0, and windows that end before they begin.
CorrectionSpec repair_spec(const RobotModel& model, const CommandSeries& series,
                           const RepairOptions& options);

/// [s]; without a flight no bound.
double shortest_flight(const CommandSeries& series);

}  // namespace ayumi
