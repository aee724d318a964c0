#pragma once
// Windows of time.

#include <utility>
#include <vector>

namespace ayumi {

using TimeWindow = std::pair<double, double>;  ///< beginning and end [s]

/// The windows in order, where overlapping or touching ones are merged.
std::vector<TimeWindow> merged(std::vector<TimeWindow> windows);

/// Whether t [s] is in one of the windows, ends included.
bool within(const std::vector<TimeWindow>& windows, double t);

}  // namespace ayumi
