#pragma once
// More room between bodies that meet although no value of the pattern is wrong: arms away from the
// legs, and a weight that is shifted less.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// Both arms held farther outwards in the whole motion, if the pattern does not move them.
void arms_aside(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The ZMP of all single supports nearer to the other foot, so that the legs lean less.
void lesser_shifts(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
