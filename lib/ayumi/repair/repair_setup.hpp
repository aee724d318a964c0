#pragma once
// What a repair is asked for, as its programs need it.

#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// Of the first round, without collisions. Throws Error(usage) for joints the robot has not,
/// weights that are not above 0, and windows that end before they begin.
CorrectionSpec repair_spec(const RobotModel& model, const CommandSeries& series,
                           const RepairOptions& options);

/// Pairs of bodies that come within 5 mm of each other in the motion, put to those there are.
void add_near_pairs(const RobotModel& model, const CommandSeries& series,
                    const CollisionModel& collisions, std::vector<int>& pairs);

/// Around errors and ZMP margins that are too small, `pad` [s] wider; those that overlap are one.
std::vector<std::pair<double, double>> windows_around(const std::vector<Finding>& findings,
                                                      double pad);

/// Where the commanded COG or ZMP are themselves at fault, not by a posture that is wrong.
std::vector<TimeWindow> wrong_plan(const ConsistencyReport& report);

/// What is written to a file: numbers of nine decimals, and only the control points and joints that
/// move, with the three zero points before and after that a cubic spline needs to begin at rest.
CorrectionTrack trimmed(const CorrectionTrack& track);

/// The control points of a trimmed track, moved as little as lets nothing change at `times`.
CorrectionTrack kept_at(CorrectionTrack track, const std::vector<double>& times);

/// An error of its free fall or its angular momentum.
bool flight_is_at_fault(const ConsistencyReport& report);

/// How far apart knots may be for what is wrong to be undone [s]: in a flight at fault, which is no
/// longer than that, and where a foot slips, at least `finest` there; else no bound.
double spacing_of_faults(const CommandSeries& series, const ConsistencyReport& report,
                         double finest);

/// Whether a joint that may not move is beyond its limits, or something is wrong at a time that may
/// not change, with the posture at an instant: then there is nothing to solve.
bool locked_out(const CorrectionSpec& spec, const ConsistencyReport& report);

}  // namespace ayumi
