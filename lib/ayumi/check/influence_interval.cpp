#include "ayumi/check/influence_interval.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

namespace {

// COG deviation that still belongs to a fault [m]. Chosen: a twentieth of the tolerance of the COG.
// No measured case changes between half and twice the value (constants.md).
constexpr double kTrace = 1e-4;
// Distance of a sole from its place that is more than rounding [m]. Chosen: between planned
// contacts, which are met to 1e-12 m, and the smallest tolerance of a sole (3e-4 m). No measured
// case changes between half and twice the value (constants.md).
constexpr double kOff = 1e-5;
// Time for which the ZMP reacts before the COG deviates by kTrace [s]. Source: docs/attribution.md.
constexpr double kPad = 0.050;
// A motion rests while all joints are slower than kStill [rad/s] for at least kRest [s]. Chosen: a
// squat reverses its direction at the lowest point, and this is not a rest. No measured case
// changes between half and twice the value (constants.md).
constexpr double kStill = 0.01, kRest = 0.020;
// A joint has turned back if it has moved back by this distance [rad], [m]. Chosen: above the
// rounding of tables in 0.1 degrees (1.7e-3 rad). No measured case changes between half and twice
// the value (constants.md).
constexpr double kTurning = 2e-3;

// Follows the joint from sample `from` in the direction `step`. Returns the sample at which its
// angle is farthest from the limit, before the angle comes back by kTurning.
int turning_point(const JudgedMotion& motion, int dof, double towards, int from, int step) {
  const auto height = [&](int k) { return towards * motion.series.samples[k].state.theta[dof]; };
  int least = from;
  for (int k = from; k >= 0 && k < motion.count(); k += step) {
    if (height(k) < height(least)) least = k;
    if (height(k) > height(least) + kTurning && least != from) break;
  }
  return least;
}

}  // namespace

int pad_samples(const JudgedMotion& motion) {
  return static_cast<int>(std::lround(kPad / motion.series.dt));
}

Interval around(const FindingWindow& window, int pad) {
  return {window.first - pad, window.last + pad};
}

Interval deviation_around(const JudgedMotion& motion, const FindingWindow& window) {
  const int gap = std::max(1, static_cast<int>(std::lround(kWindowGap / motion.series.dt)));
  const auto grow = [&](int from, int step) {
    int edge = from;
    for (int k = from; k >= 0 && k < motion.count() && std::abs(k - edge) <= gap; k += step)
      if (motion.cog_deviation[k] > kTrace) edge = k;
    return edge;
  };
  return {grow(window.first, -1), grow(window.last, 1)};
}

double displacement(const JudgedMotion& motion, int foot, int sample) {
  const SoleError& e = motion.soles[foot][sample];
  return std::max({e.slip, e.penetration, e.gap});
}

Interval displacement_around(const JudgedMotion& motion, const FindingWindow& window) {
  const int foot = window.worst.item;
  const ContactInterval& contact = motion.plan.at(static_cast<Side>(foot), window.worst.sample);
  Interval interval = around(window);
  if (!contact.contact) return interval;
  const auto off = [&](int k) { return displacement(motion, foot, k) > kOff; };
  while (interval.first > contact.first && off(interval.first - 1)) --interval.first;
  while (interval.last < contact.last && off(interval.last + 1)) ++interval.last;
  return interval;
}

Interval excursion_around(const JudgedMotion& motion, const FindingWindow& window) {
  const int dof = window.worst.item;
  const double towards = window.worst.value > window.worst.limit ? 1 : -1;
  return {turning_point(motion, dof, towards, window.first, -1),
          turning_point(motion, dof, towards, window.last, 1)};
}

Interval wrong_angle_around(const JudgedMotion& motion, const FindingWindow& window) {
  const Interval s = deviation_around(motion, window), excursion = excursion_around(motion, window);
  return {std::min(s.first, excursion.first), std::max(s.last, excursion.last)};
}

Interval flight_around(const JudgedMotion& motion, const FindingWindow& window) {
  Interval whole = around(window);
  while (motion.flies(whole.first - 1)) --whole.first;
  while (motion.flies(whole.last + 1)) ++whole.last;
  return whole;
}

Interval moved_phases(const JudgedMotion& motion, const Violation& v) {
  const Support here = motion.series.samples[v.sample].support;
  Interval phase = {v.sample, v.sample};
  const auto same = [&](int k) { return motion.series.samples[k].support == here; };
  while (phase.first > 0 && same(phase.first - 1)) --phase.first;
  while (phase.last + 1 < motion.count() && same(phase.last + 1)) ++phase.last;
  const int foot = static_cast<int>(foot_of(v));
  const auto& intervals = motion.plan.intervals[foot];
  const int n = motion.plan.index[foot][v.sample];
  const bool lands = v.sample - intervals[n].first < intervals[n].last - v.sample;
  if (lands && n > 0) phase.first = std::min(phase.first, intervals[n - 1].first);
  if (!lands && n + 1 < static_cast<int>(intervals.size()))
    phase.last = std::max(phase.last, intervals[n + 1].last);
  return phase;
}

bool comes_back(const JudgedMotion& motion, int dof, const Interval& interval) {
  double up = 0, down = 0;
  for (int k = std::max(1, interval.first); k <= std::min(motion.count() - 1, interval.last); ++k) {
    const double step =
        motion.series.samples[k].state.theta[dof] - motion.series.samples[k - 1].state.theta[dof];
    up = std::max(up, step);
    down = std::min(down, step);
  }
  return up > 0 && up > -0.5 * down && -down > 0.5 * up;
}

Interval motion_around(const JudgedMotion& motion, int sample) {
  const int rest = std::max(1, static_cast<int>(std::lround(kRest / motion.series.dt)));
  const auto moves = [&](int k) {
    return motion.series.samples[k].state.dtheta.cwiseAbs().maxCoeff() > kStill;
  };
  const auto grow = [&](int step) {
    int edge = sample;
    for (int k = sample; k >= 0 && k < motion.count() && std::abs(k - edge) <= rest; k += step)
      if (moves(k)) edge = k;
    return edge;
  };
  return {grow(-1), grow(1)};
}

}  // namespace ayumi
