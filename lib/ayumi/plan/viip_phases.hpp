#pragma once
// Patterns with VIIP phases are sampled as if those phases took no time; then the posture is held
// for as long as each of them lasts.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

bool has_viip_phases(const Pattern& pattern);

/// Throws Error(bad_pattern) naming the first VIIP phase: it moves as its controller decides, so
/// the pattern cannot be `done` ("baked").
void refuse_viip_phases(const Pattern& pattern, const std::string& done);

/// The pattern with its VIIP phases cut out of time and without its correction. Throws
/// Error(bad_pattern) for keys inside a VIIP phase and for a table beside one.
Pattern without_viip_phases(const Pattern& pattern);

/// `cut`, the samples of without_viip_phases(), with the posture held during the VIIP phases and
/// their goals noted. Throws Error(bad_pattern) where a VIIP phase begins on one foot or in motion.
CommandSeries with_viip_phases(const RobotModel& model, const Pattern& pattern,
                               const CommandSeries& cut);

}  // namespace ayumi
