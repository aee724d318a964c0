#pragma once
// Pauses of a motion: spans in which nothing moves. No limit is active there, so the author decides
// how long they last.

#include <utility>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Begin and end of a span [s].
using TimeSpan = std::pair<double, double>;

/// The spans of at least 0.1 s without motion of a joint or of the trunk, by time.
std::vector<TimeSpan> pauses_of(const CommandSeries& series);

/// The pattern with each pause, a span of the given times, in `factor` times its length, and the
/// rest shifted. A table or a correction keeps its times. Throws as stretched().
Pattern with_pauses_stretched(const RobotModel& model, const Pattern& pattern,
                              const std::vector<TimeSpan>& pauses, double factor);

}  // namespace ayumi
