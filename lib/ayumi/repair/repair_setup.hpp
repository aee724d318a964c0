#pragma once
// Prepares the programs of a repair: the options of the caller, and the places and the spacing of
// the knots that the report of the check requires.

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

/// The windows around errors, their consequences and ZMP margins that are too small, extended by
/// `pad` [s] on both sides; overlapping windows are joined.
std::vector<TimeWindow> windows_around(const std::vector<Finding>& findings, double pad);

/// Windows in which the commanded COG or ZMP itself is at fault, and not only because of a posture.
std::vector<TimeWindow> wrong_plan(const ConsistencyReport& report);

/// Adds times within the windows of all errors, which are then collocation points.
void add_error_times(const ConsistencyReport& report, double dt, std::vector<double>& times);

/// The track in the form of a file. Numbers have nine decimals. Only the control points and joints
/// that move are kept, with the three zero points on both sides that a cubic spline needs to begin
/// at rest.
CorrectionTrack trimmed(const CorrectionTrack& track);

/// The trimmed track, with control points that are moved by the smallest amount with which nothing
/// changes at `times`.
CorrectionTrack kept_at(CorrectionTrack track, const std::vector<double>& times);

/// Whether the report has an error of free fall or of angular momentum.
bool flight_is_at_fault(const ConsistencyReport& report);

/// The largest distance of knots with which violations in a faulty flight and slips of a foot can
/// be removed [s], at least `finest`. Without such violations there is no bound.
double spacing_of_faults(const CommandSeries& series, const ConsistencyReport& report,
                         double finest);

/// Whether a locked joint is beyond its limits, an error lies in a locked window, or a locked
/// posture is at fault. Then there is nothing to solve.
bool locked_out(const CorrectionSpec& spec, const ConsistencyReport& report);

/// For the first and the last posture: whether it is itself at fault and may move.
std::array<bool, 2> faulty_ends(const ConsistencyReport& report, double duration, double spacing);

}  // namespace ayumi
