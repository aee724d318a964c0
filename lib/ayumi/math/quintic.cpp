#include "ayumi/math/quintic.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

namespace {

/// Spacing of the keys [s]. Chosen: four ticks of 1 ms, over which a cubic follows a quintic of 0.1
/// s with an error below 1e-5 of its size.
constexpr double kSpacing = 0.004;

}  // namespace

TrackPoint quintic_at(const QuinticEnd& from, const QuinticEnd& to, double t) {
  const double T = to.t - from.t, u = (t - from.t) / T, d = to.value - from.value;
  const double m0 = from.rate * T, m1 = to.rate * T;
  const double a0 = from.acceleration * T * T, a1 = to.acceleration * T * T;
  const double c3 = 10 * d - 6 * m0 - 4 * m1 - 1.5 * a0 + 0.5 * a1;
  const double c4 = -15 * d + 8 * m0 + 7 * m1 + 1.5 * a0 - a1;
  const double c5 = 6 * d - 3 * (m0 + m1) - 0.5 * (a0 - a1);
  return {from.value + u * (m0 + u * (a0 / 2 + u * (c3 + u * (c4 + u * c5)))),
          (m0 + u * (a0 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)))) / T,
          (a0 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5))) / (T * T)};
}

std::vector<TrackKey> quintic_keys(const std::vector<QuinticEnd>& points) {
  std::vector<TrackKey> keys = {{points[0].t, points[0].value, Interpolation::spline}};
  for (size_t i = 1; i < points.size(); ++i) {
    const QuinticEnd &from = points[i - 1], &to = points[i];
    const int steps = std::max(1, static_cast<int>(std::ceil((to.t - from.t) / kSpacing - 1e-9)));
    for (int k = 1; k < steps; ++k) {
      const double t = from.t + (to.t - from.t) * k / steps;
      keys.push_back({t, quintic_at(from, to, t).value, Interpolation::spline});
    }
    keys.push_back({to.t, to.value, Interpolation::spline});
  }
  return keys;
}

}  // namespace ayumi
