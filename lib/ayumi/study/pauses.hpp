#pragma once
// Pauses of a motion, which are spans in which nothing moves. No limit is active there, so that the
// author decides how long they last.

#include <utility>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The beginning and the end of a span [s].
using TimeSpan = std::pair<double, double>;

/// The spans of at least 0.1 s in which no joint and no trunk moves, in the order of time.
std::vector<TimeSpan> pauses_of(const CommandSeries& series);

/// The pattern in which each pause, a span of the given times, lasts `factor` times as long, and
/// the rest is shifted. A table or a correction keeps its times. Throws the same errors as
/// stretched().
Pattern with_pauses_stretched(const RobotModel& model, const Pattern& pattern,
                              const std::vector<TimeSpan>& pauses, double factor);

}  // namespace ayumi
