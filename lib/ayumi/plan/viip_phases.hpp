#pragma once
// Patterns with VIIP phases are first sampled as if these phases had no duration; then the posture
// is held for the duration of each phase.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

bool has_viip_phases(const Pattern& pattern);

/// Throws Error(bad_pattern) that names the first VIIP phase: its controller decides the motion, so
/// the pattern cannot be `done` (for example "baked").
void refuse_viip_phases(const Pattern& pattern, const std::string& done);

/// The pattern without its VIIP phases and without its correction. Throws Error(bad_pattern) for
/// keys inside a VIIP phase and for a table together with a VIIP phase.
Pattern without_viip_phases(const Pattern& pattern);

/// `cut`, the samples of without_viip_phases(), with the posture held during the VIIP phases and
/// with their goals. Throws Error(bad_pattern) where a VIIP phase begins on one foot or in motion.
CommandSeries with_viip_phases(const RobotModel& model, const Pattern& pattern,
                               const CommandSeries& cut);

}  // namespace ayumi
