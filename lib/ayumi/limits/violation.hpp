#pragma once
// Samples of a motion that violate a limit, collected into windows. The user reads a window as one
// finding.

#include <map>
#include <utility>
#include <vector>

#include "ayumi/limits/finding.hpp"

namespace ayumi {

/// One sample that violates a limit of one kind at one item (joint, foot, pair of bodies, ...).
struct Violation {
  FindingKind kind = FindingKind::cog_residual;
  int item = 0;  ///< its meaning depends on the kind; 0 if there is only one
  int sample = 0;
  Severity severity = Severity::error;
  double value = 0, limit = 0;  ///< value in the unit of the finding
  double size =
      0;  ///< size, which orders the samples of a window; the largest one is the worst sample
  int detail = 0;  ///< detail of the worst sample; its meaning depends on the kind
};

/// The foot of a violation whose item is a foot.
inline Side foot_of(const Violation& v) { return static_cast<Side>(v.item); }

/// The item of a support_margin: the ZMP of the motion or of the command.
enum ZmpOf { kMotionZmp = 0, kCommandZmp = 1 };

/// The item of a ballistic violation: the COG of the motion, the COG of the command, or the COG of
/// the motion if it leaps at the beginning or end of the flight.
enum Fall { kMotionFalls = 0, kCommandFalls = 1, kMotionLeaps = 2 };

struct FindingWindow {
  Violation worst;
  int first = 0, last = 0;  ///< first and last sample
  int cause = -1;           ///< index of the window that causes this one; -1: it has no cause
};

/// Violations of one kind and item at most `gap` samples apart are one window. Its severity is that
/// of the worst sample. Violations of a kind and item must come in order of time.
class FindingWindows {
 public:
  explicit FindingWindows(int gap) : gap_(gap) {}
  void add(const Violation& violation) { add(violation, violation.sample, violation.sample); }
  /// A violation that lasts from `first` to `last`.
  void add(const Violation& violation, int first, int last);
  /// All windows, errors first, then by time, kind and item.
  std::vector<FindingWindow> finish() const;

 private:
  int gap_;
  std::map<std::pair<int, int>, std::vector<FindingWindow>> windows_;  ///< windows by kind and item
};

}  // namespace ayumi
