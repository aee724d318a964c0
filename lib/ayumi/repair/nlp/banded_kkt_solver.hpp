#pragma once
// Linear systems of Ipopt by condensing: of
//   [ W      J' ]   W  of the variables, S of the slacks (diagonal), J of the constraints,
//   [    S  -I  ]   D  regularization (diagonal),
//   [ J -I  -D  ]
// slacks and multipliers are eliminated first, for their pivots need no search, and what is left,
//   W + J' (S^-1 + D)^-1 J,
// is banded in programs along time: a Cholesky factorization in panels of a band. An iteration
// takes a third to a quarter of what it takes with MUMPS. Without equality
// constraints only: those have no slack to eliminate them by.

namespace ayumi {

/// Makes this solver what Ipopt takes for its linear solver "ma27". Thread-safe, idempotent.
void register_condensed_solver();

}  // namespace ayumi
