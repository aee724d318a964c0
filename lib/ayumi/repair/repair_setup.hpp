#pragma once
// What a repair is asked for, as its programs need it, and what the report of the check says about
// where and how finely a correction has to act.

#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The specification of the first round, without collisions. Throws Error(usage) for joints that
/// the robot does not have, weights that are not above 0, and windows that end before they begin.
CorrectionSpec repair_spec(const RobotModel& model, const CommandSeries& series,
                           const RepairOptions& options);

/// Adds the pairs of bodies that come near each other in the motion.
void add_near_pairs(const RobotModel& model, const CommandSeries& series,
                    const CollisionModel& collisions, std::vector<int>& pairs);

/// Windows around errors, their consequences and ZMP margins that are too small, `pad` [s] wider on
/// both sides; windows that overlap are one.
std::vector<TimeWindow> windows_around(const std::vector<Finding>& findings, double pad);

/// Windows in which the commanded COG or ZMP is itself at fault, not because a posture is wrong.
std::vector<TimeWindow> wrong_plan(const ConsistencyReport& report);

/// The track as it is written to a file: numbers of nine decimals, and only the control points and
/// joints that move, with the three zero points on both sides that a cubic spline needs to begin at
/// rest.
CorrectionTrack trimmed(const CorrectionTrack& track);

/// A trimmed track with its control points moved by the least amount for which nothing changes at
/// `times`.
CorrectionTrack kept_at(CorrectionTrack track, const std::vector<double>& times);

/// Whether the report has an error of free fall or of angular momentum.
bool flight_is_at_fault(const ConsistencyReport& report);

/// The largest distance of knots with which the violations can be undone [s]: in a flight at fault,
/// and where a foot slips, with at least `finest` there; else no bound.
double spacing_of_faults(const CommandSeries& series, const ConsistencyReport& report,
                         double finest);

/// Whether a locked joint is beyond its limits, or an error lies in a locked window, or a locked
/// posture is at fault: then there is nothing to solve.
bool locked_out(const CorrectionSpec& spec, const ConsistencyReport& report);

/// By end: whether the first and the last posture are themselves at fault, so that they may move.
std::array<bool, 2> faulty_ends(const ConsistencyReport& report, double duration, double spacing);

}  // namespace ayumi
