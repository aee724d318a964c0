#pragma once
// Mistakes in times of keyframes and ends of phases that were mistyped, or that do not fit each
// other. Each function adds to `made` the changes of the pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// The time of one keyframe, or of one line of a repeated block.
void key_times(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The end of one phase, or its duration.
void phase_times(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
