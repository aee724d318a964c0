#pragma once
// Where the given motion itself has to become smooth before a correction can help.

#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// Windows in which smooth curves should replace the motion: those around its jumps, or all of it
/// where its angles are noisy or rounded. A correction is smooth, so it removes neither. Empty if
/// the motion is smooth, if it flies (the acceleration of a flight begins with a jump), if
/// something is locked, or if much less is wrong with the motion as it is. `check` is that of the
/// motion.
std::vector<SmoothWindow> rough_windows(const RobotModel& model, const CommandSeries& series,
                                        const ConsistencyReport& check,
                                        const RepairOptions& options);

}  // namespace ayumi
