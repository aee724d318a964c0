#pragma once
// A direct solver for the linear systems of Ipopt. Each of its steps solves a system with the
// matrix
//   [ W      J' ]   W: Hessian of the Lagrangian and barrier of the variables,
//   [    S  -I  ]   S: barrier of the slacks (diagonal),   J: Jacobian of the constraints,
//   [ J -I  -D  ]   D: regularization (diagonal).
// Slacks and multipliers are eliminated first, because their pivots need no search. What remains,
//   W + J' (S^-1 + D)^-1 J,
// is banded in programs along time and is factored by Cholesky in panels of the band. An iteration
// takes a third to a quarter of the time that it takes with MUMPS. The method needs programs
// without equality constraints: an equality has no slack by which it could be eliminated.
//
// Ipopt accepts an external linear solver only under the name MA27, and the whole process has only
// one place for it. Ayumi therefore holds this place only while one of its solves runs; afterwards,
// the place is empty again. Another Ipopt program of the process that asks for MA27 at that time,
// on another thread or from within a callback, is passed on to the HSL library. A place that the
// host program has filled (with an HSL library that is loaded, or with LSL_setMA27) is left alone.

#include "ayumi/dynamics/kernels/tree_kernels.hpp"

namespace ayumi {

/// While this object lives, Ipopt's linear solver "ma27" is this solver on the thread that made the
/// object. It is thread-safe; scopes of one thread may be nested.
class BandedKktScope {
 public:
  /// If `wanted` is false, the scope does nothing. All kernels give the same bits.
  BandedKktScope(bool wanted, const kernels::Kernels& kernels);
  ~BandedKktScope();
  BandedKktScope(const BandedKktScope&) = delete;
  BandedKktScope& operator=(const BandedKktScope&) = delete;

  /// False if the solver was not wanted, or if the host program has an MA27 of its own.
  bool active() const { return active_; }

 private:
  bool outer_;
  const kernels::Kernels* outer_kernels_;
  bool active_;
};

/// While this object lives, this solver does not serve the thread that made it: for callbacks,
/// which may run other programs.
class BandedKktPause {
 public:
  BandedKktPause();
  ~BandedKktPause();
  BandedKktPause(const BandedKktPause&) = delete;
  BandedKktPause& operator=(const BandedKktPause&) = delete;

 private:
  bool outer_;
};

}  // namespace ayumi
