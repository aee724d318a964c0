#pragma once
// Samples of a motion that violate a limit, gathered into windows: a window is what the user reads
// as one finding.

#include <map>
#include <utility>
#include <vector>

#include "ayumi/limits/finding.hpp"

namespace ayumi {

/// One sample that violates one kind of limit at one item (joint, foot, pair of bodies, ...).
struct Violation {
  FindingKind kind = FindingKind::cog_residual;
  int item = 0;  ///< meaning depends on the kind; 0 where there is only one
  int sample = 0;
  Severity severity = Severity::error;
  double value = 0, limit = 0;  ///< in the unit of the finding
  double size = 0;              ///< orders the samples of a window; the largest is its worst one
  int detail = 0;               ///< of the worst sample; meaning depends on the kind
};

/// The foot of a violation whose item is one.
inline Side foot_of(const Violation& v) { return static_cast<Side>(v.item); }

/// Item of a support_margin: whose ZMP it is.
enum ZmpOf { kMotionZmp = 0, kCommandZmp = 1 };

/// Item of a ballistic violation: the COG of the motion, that of the command, or that of the motion
/// where it leaps as the flight begins or ends.
enum Fall { kMotionFalls = 0, kCommandFalls = 1, kMotionLeaps = 2 };

struct FindingWindow {
  Violation worst;
  int first = 0, last = 0;  ///< samples
  int cause = -1;           ///< index of the window this one follows from; -1: it stands alone
};

/// Violations of one kind and item at most `gap` samples apart are one window. Its severity is that
/// of the worst sample. Violations of a kind and item must come in order of time.
class FindingWindows {
 public:
  explicit FindingWindows(int gap) : gap_(gap) {}
  void add(const Violation& violation) { add(violation, violation.sample, violation.sample); }
  /// One that lasts from `first` to `last`.
  void add(const Violation& violation, int first, int last);
  /// All windows, errors first, then by time, kind and item.
  std::vector<FindingWindow> finish() const;

 private:
  int gap_;
  std::map<std::pair<int, int>, std::vector<FindingWindow>> windows_;  ///< by kind and item
};

}  // namespace ayumi
