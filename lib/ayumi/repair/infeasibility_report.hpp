#pragma once
// Why a motion cannot be made consistent: what is left of it, ranked, in words, with the time each
// window would need.

#include <vector>

#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The errors of `report` on `series`, the largest share beyond its limit first; those of one kind
/// at one joint or foot are told once, where they are worst. Where something is wrong in a locked
/// window or at a locked joint, that alone is told.
std::vector<Obstacle> obstacles(const RobotModel& model, const CommandSeries& series,
                                const ConsistencyReport& report, const RepairOptions& options);

/// Least factor by which the time of the window [s] has to grow for this kind of finding to pass
/// there, in steps of 0.01 up to 8; 0 when slowing down does not help. `where` as in the finding.
double time_factor(const RobotModel& model, const CommandSeries& series, const Finding& finding,
                   const CheckOptions& options);

/// Whether playing it slower could mend a finding: of what is asked of motors and ground, not of
/// places.
bool is_matter_of_time(const Finding& finding);

/// How much is wrong with a motion: over its errors, shares of a limit, centimetres, tenths of a
/// radian, the worst of each kind and place counted once. 0 when it passes.
double total_excess(const ConsistencyReport& report);

}  // namespace ayumi
