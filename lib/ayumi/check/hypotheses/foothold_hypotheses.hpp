#pragma once
// Footholds that are too far away, that are turned too far, or that are above the ground or in it.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// Turns of steps that were given for both feet.
void turns(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// One foothold nearer to the other foot, with all later footholds.
void near_footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// One foothold with a smaller turn, with all later footholds.
void lesser_turns(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Feet that are planned to stand above the ground or in it, at the height of the ground.
void ground_heights(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
