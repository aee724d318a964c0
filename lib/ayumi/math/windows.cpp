#include "ayumi/math/windows.hpp"

#include <algorithm>

namespace ayumi {

std::vector<TimeWindow> merged(std::vector<TimeWindow> windows) {
  std::sort(windows.begin(), windows.end());
  std::vector<TimeWindow> result;
  for (const TimeWindow& w : windows) {
    if (!result.empty() && w.first <= result.back().second)
      result.back().second = std::max(result.back().second, w.second);
    else
      result.push_back(w);
  }
  return result;
}

bool within(const std::vector<TimeWindow>& windows, double t) {
  return std::any_of(windows.begin(), windows.end(),
                     [t](const TimeWindow& w) { return t >= w.first && t <= w.second; });
}

}  // namespace ayumi
