#pragma once
// Windows of time that belong together.

#include <utility>
#include <vector>

namespace ayumi {

using TimeWindow = std::pair<double, double>;  ///< begin and end [s]

/// In order of time; those that overlap or touch are one.
std::vector<TimeWindow> merged(std::vector<TimeWindow> windows);

/// Whether t [s] is in one of them, their ends included.
bool within(const std::vector<TimeWindow>& windows, double t);

}  // namespace ayumi
