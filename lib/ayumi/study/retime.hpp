#pragma once
// The fastest uniform time scaling of a pattern that passes the check.

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

struct RetimeOptions {
  /// Chosen: the scale is rounded to three or four decimals, and half is no search any more.
  static constexpr Bounds kResolution = {1e-5, 0.5};

  CheckOptions check = {};
  double dt = 0.001;                    ///< period of sampling [s]
  double resolution = 0.002;            ///< relative resolution of the scale
  double fastest = 0.05, slowest = 20;  ///< range of the scale
};

struct FastestPace {
  bool found = false;       ///< a scale up to `slowest` passes the check
  double scale = 1;         ///< smallest scale that passes, next to one that does not
  bool bounded = false;     ///< false if even `fastest` passes
  std::string limited_by;   ///< first error at the scale just below, in words
  bool by_posture = false;  ///< this error is in the posture of a table, which no pace changes
  int evaluations = 0;      ///< number of scales that were sampled and checked
};

/// Bisection between a scale that passes the check and one that does not. The search begins at 1.
/// It goes faster by factors of 1.25 while scales pass; otherwise it goes slower by factors of
/// 1.05, or by a larger step if a joint is much too fast. A pattern with flights may pass again at
/// a faster scale than one that fails. So the search also tries scales in steps of 0.5 % beyond the
/// fastest scale that passes, down to 0.82 of it, and continues from the fastest of these that
/// passes. A scale that cannot be sampled does not pass. Throws Error(usage) for a resolution out
/// of bounds.
FastestPace fastest_pace(const RobotModel& model, const Pattern& pattern,
                         const RetimeOptions& options, const Progress& progress = {});

}  // namespace ayumi
