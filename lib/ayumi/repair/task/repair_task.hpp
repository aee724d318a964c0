#pragma once
// The repair of a task with all that its verdict counts, the payloads of its scenario included.

#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

/// repair() of the motion of a task, which has to bear the payloads of its scenario, as the verdict
/// of judge() demands. Where the nearest motion of the robot alone does not bear them, the nearest
/// one of the robot that carries all of them all the time is tried. Throws as repair().
RepairResult repair_task(const Task& task, const RepairOptions& options,
                         const Progress& progress = {});

}  // namespace ayumi
