#pragma once
// Windows of time.

#include <utility>
#include <vector>

namespace ayumi {

using TimeWindow = std::pair<double, double>;  ///< begin and end [s]

/// Sorted, with overlapping or touching windows merged.
std::vector<TimeWindow> merged(std::vector<TimeWindow> windows);

/// True when t [s] is in one of the windows, ends included.
bool within(const std::vector<TimeWindow>& windows, double t);

}  // namespace ayumi
