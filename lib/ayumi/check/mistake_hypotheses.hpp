#pragma once
// All possible mistakes in one pattern, kind by kind: the written value, the value that may have
// been meant, and the change of the pattern that tries this value.

#include <memory>
#include <string>
#include <vector>

#include "ayumi/check/mistake_search.hpp"
#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/check/written_values.hpp"

namespace ayumi {

struct ExaminedPattern;

// A value that would have to change by less than this is at a limit of the robot and is not a
// mistake. The bound is a share of the value's unit (the length of a leg, a radian, the weight, 1).
// Chosen: 1 mm for a leg of 0.2 m, 0.3 deg.
inline constexpr double kLeastMistake = 0.005;

/// Whether the phase or keyframe at this JSON pointer is one of several rounds of a block, which
/// have one text in the file: a change of another round would name the same line again.
bool is_repeated(const Pattern& pattern, const std::string& place);

/// Specificity of an explanation; the most specific one comes first.
enum class Rank { unit, geometry, slip, exchange, sign, missing, amount, pace };

struct Hypothesis {
  Rank rank = Rank::amount;
  Explanation says;
  Mend mend;
  /// Change of the value, as a share of it; the smallest of several is named first.
  double change = 0;
  double size = 0;              ///< size of this change, as a share of the value's unit
  bool only_if_enough = false;  ///< whether it is left out if errors remain after this change
};

class Hypotheses {
 public:
  enum class Kind {
    units,
    /// Keys of the ZMP under a foot that does not carry the robot. These are few.
    supports,
    times,
    /// Parts that differ from similar ones in the same pattern, or contradict another part.
    irregular,
    exchanges,
    missing,
    nearer,
    paces,
    small_swings,
    /// Smaller hops: several changes at once, for motors that are too weak.
    hops,
    /// Ways to keep bodies apart that meet. No value is wrong.
    room
  };

  /// The references must outlive the object.
  Hypotheses(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found);
  ~Hypotheses();

  const std::vector<WrittenValue>& values() const;
  /// The hypotheses of one kind. Their changes refer to this object.
  std::vector<Hypothesis> of(Kind kind) const;

 private:
  std::unique_ptr<const ExaminedPattern> examined_;
};

}  // namespace ayumi
