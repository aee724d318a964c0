#pragma once
// Attitudes of the trunk that contradict the heading of the feet.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// The trunk turned along the feet, where its keys have the yaw 0 although the feet have turned.
void trunk_headings(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
