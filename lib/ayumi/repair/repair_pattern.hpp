#pragma once
// The repair of a pattern. The pattern itself may ask for options, and its series may already have
// a correction.

#include "ayumi/motion/pattern.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The author's preferences as options. The options of the check keep their defaults.
RepairOptions preferred_options(const Pattern& pattern);

/// repair() of `series`, the samples of `pattern`. If the pattern has a correction that is not
/// enough, the motion without it is repaired. Throws the same errors as repair() and sample().
RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress = {});

/// Makes a motion from the plan of a pattern alone: the repair of `plan`, which sample_plan() made
/// of the pattern. If it fails the check, other starts are tried: the COG follows the ZMP in place
/// of its keys, and, without a key of its height, it is lower. The start with the smallest
/// violations is repaired. One that passes the check is the result as it is.
RepairResult generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                      const RepairOptions& options, const Progress& progress = {});

}  // namespace ayumi
