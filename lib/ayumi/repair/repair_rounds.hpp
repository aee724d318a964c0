#pragma once
// The rounds of a repair. Each round chooses windows around the findings of the check, solves, adds
// the correction to the motion at its full rate, and checks again. A later round has more freedom
// (wider windows, finer knots), rows for every limit that the motion has come near, and a slightly
// larger distance from the limits.

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// Makes rounds until the result passes, or until their largest number is reached. The state then
/// has the last result, or an earlier one that passes. Throws Interrupted if no partial result is
/// wanted.
void solve_rounds(RepairState& state);

}  // namespace ayumi
