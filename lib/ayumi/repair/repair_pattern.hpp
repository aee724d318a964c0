#pragma once
// The repair of a pattern: the options that the pattern itself asks for, and a series that may
// already have a correction.

#include "ayumi/motion/pattern.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The author's preferences as options; those of the check are left as they are by default.
RepairOptions preferred_options(const Pattern& pattern);

/// repair() of `series`, which `pattern` samples to. Where the pattern has a correction that is not
/// enough, the motion without it is repaired. Throws as repair() and sample().
RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress = {});

/// A motion for the plan of a pattern (sample_plan) alone: the same program finds all joints. The
/// axes of the COG that the pattern has keys of are goals.
RepairResult generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                      const RepairOptions& options, const Progress& progress = {});

}  // namespace ayumi
