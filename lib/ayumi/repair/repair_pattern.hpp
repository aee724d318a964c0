#pragma once
// The repair of a pattern. The pattern itself may ask for options, and its series may already have
// a correction.

#include "ayumi/motion/pattern.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The author's preferences as options. The options of the check keep their defaults.
RepairOptions preferred_options(const Pattern& pattern);

/// repair() of `series`, the samples of `pattern`. If the pattern has a correction that is not
/// enough, the motion without it is repaired. Throws as repair() and sample().
RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress = {});

/// Makes a motion from the plan of a pattern (sample_plan) alone: the same program finds all
/// joints. The axes of the COG for which the pattern has keys are goals.
RepairResult generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                      const RepairOptions& options, const Progress& progress = {});

}  // namespace ayumi
