#include "ayumi/check/contacts.hpp"

#include <algorithm>

namespace ayumi {

std::vector<ContactInterval> contact_intervals(const CommandSeries& series, Side side) {
  std::vector<ContactInterval> result;
  for (int k = 0; k < static_cast<int>(series.samples.size()); ++k) {
    const bool contact = supports(series.samples[k].support, side);
    if (result.empty() || result.back().contact != contact) {
      result.emplace_back();
      result.back().first = k;
      result.back().contact = contact;
    }
    result.back().last = k;
  }
  for (ContactInterval& interval : result) {
    const int middle = (interval.first + interval.last) / 2;
    interval.sole = series.samples[middle].feet[static_cast<int>(side)];
  }
  return result;
}

std::vector<int> interval_index(const std::vector<ContactInterval>& intervals) {
  std::vector<int> result;
  for (size_t i = 0; i < intervals.size(); ++i)
    result.resize(intervals[i].last + 1, static_cast<int>(i));
  return result;
}

Support ContactPlan::support(int sample) const {
  const bool left = at(Side::left, sample).contact, right = at(Side::right, sample).contact;
  if (left && right) return Support::both;
  return left ? Support::left : right ? Support::right : Support::none;
}

ContactPlan contact_plan(const CommandSeries& series) {
  ContactPlan plan;
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    plan.intervals[s] = contact_intervals(series, side);
    plan.index[s] = interval_index(plan.intervals[s]);
  }
  return plan;
}

bool at_flight_edge(const CommandSeries& series, int k) {
  constexpr int kReach = 2;  // of the differences of fill_rates()
  const int last = static_cast<int>(series.samples.size()) - 1;
  const auto flies = [&](int i) { return series.samples[i].support == Support::none; };
  for (int i = std::max(0, k - kReach); i <= std::min(last, k + kReach); ++i)
    if (flies(i) != flies(k)) return true;
  return false;
}

}  // namespace ayumi
