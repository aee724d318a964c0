#pragma once
// The reasons why a motion cannot be made consistent: the remaining errors in words, ordered by
// their severity, with the time that each window would need.

#include <vector>

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// The errors of `report` for the motion `series`; the one that exceeds its limit by the largest
/// share comes first. Errors of one kind at one joint or foot are named once, where they are worst.
/// If there are errors in a locked window or at a locked joint, only these are named.
std::vector<InfeasibilityCause> infeasibility_report(const RobotModel& model,
                                                     const CommandSeries& series,
                                                     const ConsistencyReport& report,
                                                     const RepairOptions& options);

/// The smallest factor on the duration of the window [s] with which this kind of finding passes
/// there, in steps of 0.01 up to 8; 0 if slowing down does not help.
double time_factor(const RobotModel& model, const CommandSeries& series, const Finding& finding,
                   const CheckOptions& options);

/// Whether a slower motion can remove a finding. This is true for demands on motors and ground, and
/// false for places, commands and means over a fixed time.
bool is_matter_of_time(const Finding& finding);

/// The amount by which an error exceeds its limit, comparable between errors of different kinds: in
/// shares of the limit, centimetres or tenths of a radian.
double severity_of(const Finding& finding);

/// The sum of the severities (severity_of()) of the errors of a motion. Of each kind and place,
/// only the worst error counts. It is 0 if the motion passes.
double total_violation(const ConsistencyReport& report);

/// Solves the last program with every limit relaxed. The motion with the smallest violation,
/// weighted by the prices of the limits, shows what prevents a repair. Throws Interrupted.
void solve_relaxed(RepairState& state);

}  // namespace ayumi
