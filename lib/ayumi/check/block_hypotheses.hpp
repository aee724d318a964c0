#pragma once
// Blocks of phases and of keyframes that repeat, but do not fit each other: another number of
// rounds, another length of a round, or keyframes that are late by whole rounds. A walk repeats its
// steps in both lists, and an author easily changes only one of them.

#include <vector>

#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi {

/// The changes with which the first block of keyframes fits the first block of phases. Nothing if
/// one of the lists has no block of at least two rounds, or if the blocks fit.
std::vector<Hypothesis> block_hypotheses(const Pattern& pattern);

}  // namespace ayumi
