#pragma once
// What an author has probably written wrongly, where a pattern cannot be sampled or is
// inconsistent. A finding names a joint and an instant; what the author wrote is a unit, a
// foothold, a key. First one thing after the other is put right on trial (mistake_search). Where
// that explains nothing, the values that the robot cannot do are named, whatever fails first.

#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// What is likely to be wrong in a pattern.
struct Mistake {
  std::string place;  ///< JSON pointer in the file; "" for the whole pattern
  std::string words;
  bool explains_all = false;  ///< put right, the pattern is consistent
  bool is_cause = true;       ///< false: no cause was found, and the words say what was tried

  std::string text() const { return place.empty() ? words : place + ": " + words; }
};

/// The values that the robot cannot do. A consistent pattern may have some of them, too: ask only
/// where something is wrong. Takes no time.
std::vector<Mistake> impossible_values(const RobotModel& model, const Pattern& pattern);

/// Mistakes that a consistent pattern may contain: a single support without a swing among others
/// with one, angles of a few degrees that look like radians, ground that is rougher than any,
/// pushes that no robot survives, and disturbances after the end.
std::vector<Mistake> doubtful_values(const RobotModel& model, const Pattern& pattern);

/// What, put right, would make the pattern consistent; where nothing does, its impossible values.
/// Samples and checks the pattern some fifty times, which takes a few seconds, and at most 300
/// times; the last mistake says so where this bound ended the search. `progress` may stop it.
std::vector<Mistake> likely_mistakes(const RobotModel& model, const Pattern& pattern,
                                     const CheckOptions& options, const Progress& progress = {});

/// Those that are causes, in words.
std::vector<std::string> cause_texts(const std::vector<Mistake>& mistakes);

/// "likely cause: ...; the first thing that fails: MESSAGE", or MESSAGE where no mistake is
/// likely. What a search tried that found no cause stands behind MESSAGE. The name of the pattern's
/// file, where MESSAGE begins with it, stays in front.
std::string with_mistakes(const std::string& message, const Pattern& pattern,
                          const std::vector<Mistake>& mistakes);

}  // namespace ayumi
