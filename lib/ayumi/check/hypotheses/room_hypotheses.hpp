#pragma once
// More room between bodies that meet although no single value of the pattern is wrong: arms away
// from the legs, and a weight that is shifted less. These are ways out, and no mistakes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// Both arms held farther outwards in the whole motion, if a part of an arm meets another body and
/// the pattern does not move the arms.
void arms_aside(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The ZMP nearer to the other foot wherever a key puts it in the middle of a sole that stands, if
/// a part of a leg meets another body.
void lesser_shifts(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
