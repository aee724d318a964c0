#include "ayumi/limits/violation.hpp"

#include <algorithm>
#include <tuple>

namespace ayumi {

void FindingWindows::add(const Violation& v, int first, int last) {
  std::vector<FindingWindow>& windows = windows_[{static_cast<int>(v.kind), v.item}];
  if (windows.empty() || first - windows.back().last > gap_) {
    windows.push_back({v, first, last});
    return;
  }
  FindingWindow& window = windows.back();
  window.first = std::min(window.first, first);
  window.last = std::max(window.last, last);
  const bool graver = v.severity < window.worst.severity;
  const bool same = v.severity == window.worst.severity;
  if (graver || (same && v.size > window.worst.size)) window.worst = v;
}

std::vector<FindingWindow> FindingWindows::finish() const {
  std::vector<FindingWindow> result;
  for (const auto& entry : windows_)
    result.insert(result.end(), entry.second.begin(), entry.second.end());
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tie(a.worst.severity, a.first) < std::tie(b.worst.severity, b.first);
  });
  return result;
}

}  // namespace ayumi
