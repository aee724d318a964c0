#pragma once
// Trial versions of a pattern: each is sampled and checked, quickly or exactly, and its errors are
// counted.

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

// Number of errors of a motion that cannot be sampled. Definition: more than any other motion can
// have.
inline constexpr int kUnsampled = std::numeric_limits<int>::max();

/// Whether findings of a kind are about the table at the servo's own period, so that they mean
/// nothing at coarser steps of time.
bool needs_servo_period(FindingKind kind);

struct Window {
  double begin = 0, end = 0;
};

struct TrialOutcome {
  int errors = kUnsampled;
  int findings = kUnsampled;  ///< number of errors and of the findings that follow from them
  /// Windows of the first errors that follow from no other one [s].
  std::vector<Window> windows = {};

  /// Pairs of bodies that overlap in errors, as indices into RobotModel::bodies().
  std::vector<std::pair<int, int>> meeting = {};

  /// Set by exactly() if it finds errors: a quick trial finds none of them, because they only show
  /// at the servo's own period.
  bool table_alone = false;
  bool of_table = false;  ///< all errors are about the table for the robot
  bool slight = false;    ///< all errors and what follows from them are slight

  bool good() const { return errors == 0; }
  bool touches(double begin, double end) const {
    return errors == kUnsampled ||
           std::any_of(windows.begin(), windows.end(),
                       [&](const Window& w) { return w.begin <= end && begin <= w.end; });
  }
};

using Mend = std::function<void(Pattern&)>;

/// Samples and checks versions of a pattern: quickly, without the findings that need the servo's
/// period, or exactly.
class Trials {
 public:
  /// Makes at most `most` quick trials, and only kPatience of them if no change helps. The
  /// references must outlive the object.
  Trials(const RobotModel& model, const Pattern& pattern, const CheckOptions& options,
         const Progress& progress, int most);

  /// From now on, trials use the servo's period and have all findings. Each of them counts as the
  /// number of quick trials that take as long.
  void make_exact() { exact_ = true; }
  bool exact() const { return exact_; }
  /// Whether exact trials have a smaller time step than quick ones.
  bool finer_when_exact() const { return ticks_ > 1; }

  /// The outcome, at the servo's period, of a version that is good in a quick trial.
  TrialOutcome exactly(Pattern pattern, const Mend& mend) const;
  TrialOutcome of(const Pattern& pattern) const { return of(pattern, exact_); }
  TrialOutcome of(const Pattern& pattern, bool exact) const;
  TrialOutcome after(const Pattern& pattern, const Mend& mend) {
    return after(pattern, std::vector<Mend>{mend}).front();
  }
  /// The outcomes in the same order. Versions for which no trials are left count as motions that
  /// cannot be sampled.
  std::vector<TrialOutcome> after(const Pattern& pattern, const std::vector<Mend>& mends);

  /// Notes that a change leaves few errors, so that all trials may be made.
  void go_on() { promising_ = true; }
  /// Whether the number of trials ended the search while something was left to try.
  bool ended() const { return ended_; }
  int made() const { return made_; }
  /// Notes that the search leaves out changes that could have been tried.
  void leave_out() { left_out_ = true; }
  bool left_out() const { return left_out_; }

 private:
  /// How many trials one quick trial of this pattern counts as.
  int quick_cost(const Pattern& pattern) const;

  const RobotModel& model_;
  CheckOptions options_;
  const Progress& progress_;
  int threads_ = 0, most_ = 0;
  int ticks_ = 1;     ///< ticks of the servo in one time step of a quick trial
  int leg_cost_ = 1;  ///< how many trials one trial counts as if a leg has fewer than six joints
  int made_ = 0;      ///< cost of the trials so far
  int tried_ = 0;     ///< number of trials so far
  bool ended_ = false, left_out_ = false, exact_ = false, promising_ = false;
};

}  // namespace ayumi
