#pragma once
// Linear systems of Ipopt by condensing: of
//   [ W      J' ]   W  of the variables, S of the slacks (diagonal), J of the constraints,
//   [    S  -I  ]   D  regularization (diagonal),
//   [ J -I  -D  ]
// slacks and multipliers are eliminated one by one, and what is left,
//   W + J' (S^-1 + D)^-1 J,
// is banded in programs along time: a Cholesky factorization in blocks as wide as the band. MUMPS
// cannot know that the pivots need no search and spends ten times as long. Without equality
// constraints only: those have no slack to eliminate them by.

namespace ayumi {

/// Makes this solver what Ipopt takes for its linear solver "ma27". Thread-safe, idempotent.
void register_condensed_solver();

}  // namespace ayumi
