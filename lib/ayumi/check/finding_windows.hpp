#pragma once
// Samples that violate something, gathered into windows: what the user reads as one finding.

#include <map>
#include <utility>
#include <vector>

#include "ayumi/check/finding_kinds.hpp"

namespace ayumi {

/// One sample of one kind at one item (joint, foot, pair, ...).
struct Violation {
  FindingKind kind = FindingKind::cog_residual;
  int item = 0;  ///< meaning depends on the kind
  int sample = 0;
  Severity severity = Severity::error;
  double value = 0, limit = 0;  ///< in the unit of the finding
  double excess = 0;            ///< how bad, for choosing the worst sample
  int detail = 0;               ///< carried along from the worst sample
};

/// Detail of a servo step that is one of the target with its lead, not of the posture.
inline constexpr int kServoTarget = 1;

/// The foot of a violation whose item is one.
inline Side foot_of(const Violation& v) { return static_cast<Side>(v.item); }

/// Item of a ballistic finding: of the motion, of the command, or of the motion where it leaps as
/// the flight begins or ends.
enum Fall { kMotionFalls = 0, kCommandFalls = 1, kMotionLeaps = 2 };

struct FindingWindow {
  Violation worst;
  int first = 0, last = 0;  ///< samples
  int cause = -1;           ///< index of the window this one follows from; -1: its own
};

/// Violations of one kind and item at most `gap` samples apart are one window. Severity is that of
/// the worst sample. Violations of a kind and item must come in order of time.
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
