#pragma once
// Probable mistakes of an author, found by trial: one thing in the pattern is changed, and the
// motion is sampled and checked again. Changes that make the pattern consistent are named, the most
// specific first: a unit, a decimal point, an exchanged side, a sign, something that is missing,
// then a value that is too large or too small. A motion whose errors are all slight is near its
// limits. For such a motion, another sign, digit or foot is tried only if something else in the
// pattern makes this mistake likely.

#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

struct Explanation {
  std::string place;    ///< JSON pointer in the pattern's file
  std::string written;  ///< the written value: "the right foot's x is 0.9 m"
  std::string instead;  ///< the remedy: "with 0.09 m, ..., the pattern would be consistent"
  bool enough = false;  ///< whether the pattern is consistent with this change
  /// The changes of one round are alternatives. After the first round (0), one change of each
  /// earlier round is also needed.
  int round = 0;
  bool is_way_out = false;  ///< whether no value is wrong; such explanations come last
};

/// Largest number of versions of the pattern that are sampled and checked in all rounds together.
/// Chosen: the longest search of tests/check takes between 160 and 300 trials; a trial of a walk
/// takes 20 ms of processor time on a robot of primitive shapes.
inline constexpr int kMostTrials = 300;

struct Explanations {
  std::vector<Explanation> found;
  int trials = 0;  ///< number of versions that were sampled and checked; a version with more
                   ///< samples, or with legs of fewer than six joints, counts as several
  /// If false, errors remain, and more could have been tried: the bound on trials was reached, or
  /// there were too many possible mistakes of one kind.
  bool complete = true;
};

/// The changes that explain the errors. If one change is not enough, there are several in sequence,
/// each with the errors that it leaves. The result is empty for a consistent pattern, or if no
/// change helps. The number of trials is bounded, not their time, so that the same input gives the
/// same result. `progress` may stop it.
Explanations find_explanations(const RobotModel& model, const Pattern& pattern,
                               const CheckOptions& options, const Progress& progress,
                               int most_trials = kMostTrials);

}  // namespace ayumi
