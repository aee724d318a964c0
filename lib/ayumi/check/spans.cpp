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
