#pragma once
// Finds repeated blocks of phases and of keyframes that do not fit each other: they differ in
// number or length of rounds, or are shifted by whole rounds. A walk repeats its steps in both
// lists, and an author easily changes only one of them.

#include <vector>

#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi {

/// The changes with which the first block of keyframes fits the first block of phases. The result
/// is empty if one of the lists has no block of at least two rounds, if a block contains another
/// block, or if the blocks fit.
std::vector<Hypothesis> block_hypotheses(const Pattern& pattern);

}  // namespace ayumi
