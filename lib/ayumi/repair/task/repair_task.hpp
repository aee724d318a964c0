#pragma once
// The repair of a task. The motion must pass everything that the verdict of the task counts, with
// the payloads of its scenario.

#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

/// repair() of the motion of a task, which has to be consistent with the payloads of its scenario,
/// as the verdict of judge() requires. If the nearest motion of the robot alone is not consistent
/// with them, the nearest motion of a robot that carries all of them all the time is tried. If a
/// goal of VIIP is impossible or too much for the profile, this is not a repair, whatever the
/// motion is, and the goal is the first reason. Throws the same errors as repair().
RepairResult repair_task(const Task& task, const RepairOptions& options,
                         const Progress& progress = {});

}  // namespace ayumi
