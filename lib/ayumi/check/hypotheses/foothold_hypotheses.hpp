#pragma once
// Mistakes in footholds that are too far away, that are turned too far, or that are above the
// ground or in it. Each function adds to `made` the changes of the pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// A turn of 0 for the steps of the second foot, if the turn was stated for the steps of both feet.
void turns(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// One foothold that is moved nearer to the other foot, together with all later footholds.
void near_footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// One foothold with a smaller turn; all later footholds turn with it.
void lesser_turns(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The height of the ground for feet that are planned to stand above the ground or in it.
void ground_heights(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
