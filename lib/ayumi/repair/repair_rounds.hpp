#pragma once
// The rounds of a repair: choose windows around what the check found, solve, lay the correction
// over the motion at full rate, check again. A later round frees more (wider windows, finer knots),
// watches every limit that has become near, and keeps a little more distance from the limits.

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// Rounds until the result passes, or until there are too many. The state then holds the last
/// result, or an earlier one that passes. Throws Interrupted where no partial result is wanted.
void solve_rounds(RepairState& state);

}  // namespace ayumi
