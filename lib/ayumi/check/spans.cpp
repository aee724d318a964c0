#include "ayumi/check/spans.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

namespace {

constexpr double kTrace = 1e-4;    // COG deviation that still belongs to a fault [m]
constexpr double kOff = 1e-5;      // out of its place, of a sole [m]
constexpr double kSlack = 0.050;   // the ZMP answers before the COG is off by kTrace [s]
constexpr double kStill = 0.01;    // joints slower than this rest [rad/s]
constexpr double kRest = 0.020;    // for at least so long: a squat only turns at its depth [s]
constexpr double kTurning = 2e-3;  // way back that tells that a joint has turned [rad], [m]

// Where theta, going away from its limit, is least before it comes back by kTurning.
int turning_point(const CheckPass& pass, int dof, double towards, int from, int step) {
  const auto height = [&](int k) { return towards * pass.series.samples[k].state.theta[dof]; };
  int least = from;
  for (int k = from; k >= 0 && k < pass.count(); k += step) {
    if (height(k) < height(least)) least = k;
    if (height(k) > height(least) + kTurning && least != from) break;
  }
  return least;
}

}  // namespace

int slack_samples(const CheckPass& pass) {
  return static_cast<int>(std::lround(kSlack / pass.series.dt));
}

Span around(const FindingWindow& window, int slack) {
  return {window.first - slack, window.last + slack};
}

Span deviation_around(const CheckPass& pass, const FindingWindow& window) {
  const int gap = std::max(1, static_cast<int>(std::lround(kWindowGap / pass.series.dt)));
  const auto grow = [&](int from, int step) {
    int edge = from;
    for (int k = from; k >= 0 && k < pass.count() && std::abs(k - edge) <= gap; k += step)
      if (pass.cog_deviation[k] > kTrace) edge = k;
    return edge;
  };
  return {grow(window.first, -1), grow(window.last, 1)};
}

double displacement(const CheckPass& pass, int foot, int sample) {
  const SoleError& e = pass.soles[foot][sample];
  return std::max({e.slip, e.penetration, e.gap});
}

Span displacement_around(const CheckPass& pass, const FindingWindow& window) {
  const int foot = window.worst.item;
  const ContactInterval& contact = pass.plan.at(static_cast<Side>(foot), window.worst.sample);
  Span span = around(window);
  if (!contact.contact) return span;
  const auto off = [&](int k) { return displacement(pass, foot, k) > kOff; };
  while (span.first > contact.first && off(span.first - 1)) --span.first;
  while (span.last < contact.last && off(span.last + 1)) ++span.last;
  return span;
}

Span stroke_around(const CheckPass& pass, const FindingWindow& window) {
  const int dof = window.worst.item;
  const double towards = window.worst.value > window.worst.limit ? 1 : -1;
  return {turning_point(pass, dof, towards, window.first, -1),
          turning_point(pass, dof, towards, window.last, 1)};
}

Span moved_phases(const CheckPass& pass, const Violation& v) {
  const Support here = pass.series.samples[v.sample].support;
  Span phase = {v.sample, v.sample};
  const auto same = [&](int k) { return pass.series.samples[k].support == here; };
  while (phase.first > 0 && same(phase.first - 1)) --phase.first;
  while (phase.last + 1 < pass.count() && same(phase.last + 1)) ++phase.last;
  const int foot = static_cast<int>(foot_of(v));
  const auto& intervals = pass.plan.intervals[foot];
  const int n = pass.plan.index[foot][v.sample];
  const bool lands = v.sample - intervals[n].first < intervals[n].last - v.sample;
  if (lands && n > 0) phase.first = std::min(phase.first, intervals[n - 1].first);
  if (!lands && n + 1 < static_cast<int>(intervals.size()))
    phase.last = std::max(phase.last, intervals[n + 1].last);
  return phase;
}

bool comes_back(const CheckPass& pass, int dof, const Span& span) {
  double up = 0, down = 0;
  for (int k = std::max(1, span.first); k <= std::min(pass.count() - 1, span.last); ++k) {
    const double step =
        pass.series.samples[k].state.theta[dof] - pass.series.samples[k - 1].state.theta[dof];
    up = std::max(up, step);
    down = std::min(down, step);
  }
  return up > 0 && up > -0.5 * down && -down > 0.5 * up;
}

Span motion_around(const CheckPass& pass, int sample) {
  const int rest = std::max(1, static_cast<int>(std::lround(kRest / pass.series.dt)));
  const auto moves = [&](int k) {
    return pass.series.samples[k].state.dtheta.cwiseAbs().maxCoeff() > kStill;
  };
  const auto grow = [&](int step) {
    int edge = sample;
    for (int k = sample; k >= 0 && k < pass.count() && std::abs(k - edge) <= rest; k += step)
      if (moves(k)) edge = k;
    return edge;
  };
  return {grow(-1), grow(1)};
}

}  // namespace ayumi
