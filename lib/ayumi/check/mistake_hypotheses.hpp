#pragma once
// All possible mistakes in one pattern, kind by kind: the written value, the value that may have
// been meant, and the change of the pattern that tries this value.

#include <memory>
#include <vector>

#include "ayumi/check/mistake_search.hpp"
#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/check/written_values.hpp"

namespace ayumi {

// A value that would have to change by less than this is at a limit of the robot, and no mistake: a
// share of its unit (the length of a leg, a radian, the weight, 1). Chosen: 1 mm for a leg of 0.2
// m, 0.3 deg.
inline constexpr double kLeastMistake = 0.005;

/// Specificity of an explanation.
enum class Rank { unit, geometry, slip, exchange, sign, missing, amount, pace };

struct Hypothesis {
  Rank rank = Rank::amount;
  Explanation says;
  Mend mend;
  double change = 0;  ///< of a value, as a share of it: the least of several amounts is named first
  double size = 0;    ///< of this change, as a share of the value's unit
};

class Hypotheses {
 public:
  enum class Kind {
    units,
    times,
    irregular,  ///< what differs from its like in the same pattern, or contradicts another part
    exchanges,
    missing,
    nearer,
    paces
  };

  /// The references must outlive the object.
  Hypotheses(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found);
  ~Hypotheses();

  const std::vector<WrittenValue>& values() const;
  /// Their changes refer to this object.
  std::vector<Hypothesis> of(Kind kind) const;

 private:
  class Maker;
  std::unique_ptr<Maker> maker_;
};

}  // namespace ayumi
