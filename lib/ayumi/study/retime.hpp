#pragma once
// How fast a pattern can be played: uniform time scaling against the check.

#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

struct RetimeOptions {
  CheckOptions check;
  double dt = 0.001;          ///< of sampling [s]
  double resolution = 0.002;  ///< of the scale, relative
  double fastest = 0.05, slowest = 20;
};

struct FastestPace {
  bool found = false;       ///< some scale up to `slowest` passes the check
  double scale = 1;         ///< the least that passes, next to one that does not
  bool bounded = false;     ///< false: even `fastest` passes
  std::string limited_by;   ///< the first error at the scale just below, in words
  bool by_posture = false;  ///< it is in the posture of a table, which no pace changes
  int evaluations = 0;
};

/// Bisection between a scale that passes check and one that does not, from 1 on: by quarters
/// faster while it passes, else slower by twentieths, or most of the way to where joint speeds that
/// are too high would do; beyond the edge, down to 0.82 of it, every half percent is
/// tried too, and the search goes on from the fastest that passes. A scale that cannot be sampled
/// does not pass.
FastestPace fastest_pace(const RobotModel& model, const Pattern& pattern,
                         const RetimeOptions& options, const Progress& progress = {});

}  // namespace ayumi
