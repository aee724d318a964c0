#include "ayumi/demand/contact_plan.hpp"

#include <algorithm>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/kinematics.hpp"

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

RunOn swing_run_on(const RobotModel& model, const CommandSeries& series, Side side,
                   const ContactInterval& contact, bool lands) {
  // Share of the height at the beginning or end of the contact below which the sole counts as being
  // in its place. Chosen: a swing that ends as (1 - s)^3 has a quarter of its remaining time left
  // there. No measured case changes between half and twice the value (constants.md).
  constexpr double kArrived = 0.02;
  // A sole that is still swinging comes down without a halt by at least this share of the height.
  // Chosen: a sole that is at rest above its place and then comes down a little is floating, which
  // is judged by its height. Between half and twice the value, figures change by less than 5 %.
  constexpr double kRunOnFall = 0.8;
  const int edge = lands ? contact.first : contact.last, step = lands ? 1 : -1;
  const Eigen::Isometry3d inverse = contact.sole.inverse();
  const Eigen::Vector3d center(model.sole(side).center.x(), model.sole(side).center.y(), 0);
  RobotData data(model);
  const auto height = [&](int k) {
    update_positions(model, series.samples[k].state, data);
    return (inverse * (sole_pose(model, data, side) * center)).z();
  };
  const double at_edge = height(edge);
  RunOn run;
  if (at_edge <= 0) return run;
  double lowest = at_edge;
  for (int k = edge + step; k >= contact.first && k <= contact.last; k += step) {
    const double now = height(k);
    if (now > lowest) break;
    lowest = now;
    if (now > kArrived * at_edge) run.samples = std::abs(k - edge);
  }
  if (lowest > (1 - kRunOnFall) * at_edge) return {};
  run.height = at_edge;
  return run;
}

double samples_after_contact(const RobotModel& model, const CommandSeries& series, Side side,
                             const ContactInterval& contact, const ContactInterval& swing) {
  // Distance from its place at which a sole counts as leaving it [m]. Source: docs/attribution.md
  // ("Contacts that end too early"); planned contacts are met to 1e-12 m.
  constexpr double kOff = 1e-5;
  RobotData data(model);
  int off = -1;
  for (int k = swing.first; k <= swing.last; ++k) {
    update_positions(model, series.samples[k].state, data);
    const SoleError e = sole_error(model.sole(side), sole_pose(model, data, side), contact.sole);
    const double way = std::max({e.slip, e.penetration, e.gap});
    if (off < 0 && way > kOff) off = k;
    if (way > 8 * kOff) return 2 * off - k - swing.first;
  }
  return 0;
}

bool at_flight_edge(const CommandSeries& series, int k) {
  // Number of samples on either side. Derived: the number that fill_rates() of
  // motion/differentiate.hpp uses.
  constexpr int kReach = 2;
  const int last = static_cast<int>(series.samples.size()) - 1;
  const auto flies = [&](int i) { return series.samples[i].support == Support::none; };
  for (int i = std::max(0, k - kReach); i <= std::min(last, k + kReach); ++i)
    if (flies(i) != flies(k)) return true;
  return false;
}

}  // namespace ayumi
