#pragma once
// What an author has probably written wrongly, where a pattern cannot be sampled or is
// inconsistent. A finding names a joint and an instant; what the author wrote is a unit, a
// foothold, a key. Each rule compares a value of the pattern with what the robot can do, and none
// of them depends on where the motion fails first.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Sentences, each with the place in the file; empty where every value is a possible one. A
/// consistent pattern may have some of them, too: ask only where something is wrong.
std::vector<std::string> likely_mistakes(const RobotModel& model, const Pattern& pattern);

/// "message; likely cause: ...", or the message where no mistake is likely.
std::string with_likely_mistakes(const std::string& message, const RobotModel& model,
                                 const Pattern& pattern);

}  // namespace ayumi
