#pragma once
// Probable mistakes of the author, if a pattern cannot be sampled or is inconsistent. A finding
// names a joint and a time, but the author wrote units, footholds and keys. First, single changes
// are tried one after the other (mistake_search). If no change helps, the values that are
// impossible for the robot are named, independently of the first error.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// A probable mistake in a pattern.
struct Mistake {
  std::string place;  ///< JSON pointer in the file; "" for the whole pattern
  std::string words;
  bool explains_all = false;  ///< after the correction, the pattern is consistent
  bool is_cause = true;       ///< if false, no cause was found, and the words say what was tried
  int round = 0;              ///< as Explanation::round: mistakes of one round are alternatives

  std::string text() const { return place.empty() ? words : place + ": " + words; }
};

/// The values that are impossible for the robot. A consistent pattern may also contain some of
/// them, so call this only if something is wrong. It takes very little time.
std::vector<Mistake> impossible_values(const RobotModel& model, const Pattern& pattern);

/// The first phase whose swing lasts longer than any swing of a robot, or the whole motion (place
/// "") if it lasts longer than any motion without a swing: the times are probably milliseconds.
/// `explains_all` says whether the motion with all times read as ms passes the check; only this
/// short motion is computed. Returns nothing if the times are usual.
std::optional<Mistake> times_in_ms(const RobotModel& model, const Pattern& pattern,
                                   const CheckOptions& options);

/// Mistakes that a consistent pattern may contain: a single support without a swing although the
/// others have one, feet that do not stand on the ground, angles of a few degrees that look like
/// radians, a friction coefficient that no real ground has, pushes that no robot survives, and
/// disturbances after the end.
std::vector<Mistake> doubtful_values(const RobotModel& model, const Pattern& pattern);

/// The changes that would make the pattern consistent or, if there is none, its impossible values.
/// Samples and checks the pattern about fifty times, which takes a few seconds, and at most 300
/// times; if this bound ended the search, the last mistake says so. `progress` may stop it.
std::vector<Mistake> likely_mistakes(const RobotModel& model, const Pattern& pattern,
                                     const CheckOptions& options, const Progress& progress = {});

/// The words of those mistakes that are causes.
std::vector<std::string> cause_texts(const std::vector<Mistake>& mistakes);

/// The error with the message "likely cause: .... First error: WORDS", or `error` itself if
/// no mistake is likely. If a search found no cause, the changes that it tried follow its message.
/// If the error is in the pattern's file, the name of the file stays in front.
Error with_mistakes(const Error& error, const Pattern& pattern,
                    const std::vector<Mistake>& mistakes);

}  // namespace ayumi
