#pragma once
// Reasons why a motion cannot be made consistent. They are the errors that remain, ordered by their
// severity and put in words, with the time that each window would need.

#include <vector>

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// The errors of `report` on `series`, the largest share beyond its limit first; errors of one kind
/// at one joint or foot are named once, where they are worst. If there are errors in a locked
/// window or at a locked joint, only these are named.
std::vector<InfeasibilityCause> infeasibility_report(const RobotModel& model,
                                                     const CommandSeries& series,
                                                     const ConsistencyReport& report,
                                                     const RepairOptions& options);

/// The smallest factor on the duration of the window [s] with which this kind of finding passes
/// there, in steps of 0.01 up to 8; 0 when slowing down does not help.
double time_factor(const RobotModel& model, const CommandSeries& series, const Finding& finding,
                   const CheckOptions& options);

/// Whether a slower motion can remove a finding. This is true for demands on motors and ground, and
/// false for places, commands and means over a fixed time.
bool is_matter_of_time(const Finding& finding);

/// How far an error goes beyond its limit, comparable among errors of different kinds: in shares of
/// the limit, centimetres or tenths of a radian.
double severity_of(const Finding& finding);

/// Sum of severities over the errors of a motion, the worst of each kind and place counted once:
/// shares of a limit, centimetres, tenths of a radian. 0 when it passes.
double total_violation(const ConsistencyReport& report);

/// Solves the last program with every limit relaxed. The motion that violates least, by the prices
/// of the limits, shows what prevents a repair. Throws Interrupted.
void solve_relaxed(RepairState& state);

}  // namespace ayumi
