// Hermite form on u in [0, 1], rates m scaled by the segment's length T:
//   p = v0 + m0 u + (3 d - 2 m0 - m1) u^2 + (m0 + m1 - 2 d) u^3,  d = v1 - v0.
// A spline run has equal accelerations on both sides of each inner key:
//   m_{i-1}/T_i + 2 m_i (1/T_i + 1/T_{i+1}) + m_{i+1}/T_{i+1} = 3 (d_i/T_i^2 + d_{i+1}/T_{i+1}^2).
#include "ayumi/math/track.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

std::array<double, 6> hermite(double v0, double v1, double m0, double m1) {
  const double d = v1 - v0;
  return {v0, m0, 3 * d - 2 * m0 - m1, m0 + m1 - 2 * d, 0, 0};
}

bool is_curve(Interpolation kind) {
  return kind == Interpolation::cubic || kind == Interpolation::spline;
}

double slope(const std::vector<TrackKey>& keys, size_t segment) {
  return (keys[segment + 1].value - keys[segment].value) / (keys[segment + 1].t - keys[segment].t);
}

// The rate at key i, which is the end of a run of cubic or spline segments.
double end_rate(const std::vector<TrackKey>& keys, size_t i, bool neighbour_before) {
  if (neighbour_before ? i == 0 : i + 1 >= keys.size()) return 0;
  const size_t neighbour = neighbour_before ? i - 1 : i;
  return keys[neighbour + 1].interpolation == Interpolation::linear ? slope(keys, neighbour) : 0;
}

// The rates of the keys first..last of a run of spline segments with given end rates, by Thomas'
// algorithm.
void solve_spline(const std::vector<TrackKey>& keys, size_t first, size_t last,
                  std::vector<double>& rate) {
  const size_t n = last - first;
  std::vector<double> upper(n, 0.0);
  for (size_t i = 1; i < n; ++i) {
    const size_t k = first + i;
    const double before = 1.0 / (keys[k].t - keys[k - 1].t);
    const double after = 1.0 / (keys[k + 1].t - keys[k].t);
    const double right = 3 * (slope(keys, k - 1) * before + slope(keys, k) * after);
    const double pivot = 2 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    rate[k] = (right - before * rate[k - 1]) / pivot;
  }
  for (size_t i = n - 1; i >= 1; --i) rate[first + i] -= upper[i] * rate[first + i + 1];
}

// The rates at both ends of every cubic or spline segment, as [segment][begin, end].
std::vector<std::array<double, 2>> curve_rates(const std::vector<TrackKey>& keys) {
  const size_t segments = keys.size() - 1;
  std::vector<std::array<double, 2>> rates(segments, {0.0, 0.0});
  for (size_t first = 0; first < segments;) {
    const Interpolation kind = keys[first + 1].interpolation;
    size_t last = first + 1;
    while (last < segments && keys[last + 1].interpolation == kind) ++last;
    if (is_curve(kind)) {
      std::vector<double> rate(keys.size(), 0.0);
      rate[first] = end_rate(keys, first, true);
      rate[last] = end_rate(keys, last, false);
      if (kind == Interpolation::spline) {
        solve_spline(keys, first, last, rate);
      } else {
        for (size_t i = first + 1; i < last; ++i)
          rate[i] = (keys[i + 1].value - keys[i - 1].value) / (keys[i + 1].t - keys[i - 1].t);
      }
      for (size_t i = first; i < last; ++i) rates[i] = {rate[i], rate[i + 1]};
    }
    first = last;
  }
  return rates;
}

}  // namespace

TrackPoint minimum_jerk(double u) {
  if (u <= 0) return {0, 0, 0};
  if (u >= 1) return {1, 0, 0};
  const double w = u * (1 - u);
  return {u * u * u * (10 + u * (-15 + 6 * u)), 30 * w * w, 60 * w * (1 - 2 * u)};
}

Track::Track(std::vector<TrackKey> keys) : keys_(std::move(keys)) {
  require(!keys_.empty(), "a track needs a key");
  for (size_t i = 0; i < keys_.size(); ++i) {
    require(std::isfinite(keys_[i].t) && std::isfinite(keys_[i].value), "a key is not finite");
    require(i == 0 || keys_[i].t > keys_[i - 1].t, "key times do not increase");
  }
  const auto rates = curve_rates(keys_);
  for (size_t i = 0; i + 1 < keys_.size(); ++i) {
    const double v0 = keys_[i].value, v1 = keys_[i + 1].value;
    const double d = v1 - v0, length = keys_[i + 1].t - keys_[i].t;
    switch (keys_[i + 1].interpolation) {
      case Interpolation::linear:
        segments_.push_back({v0, d, 0, 0, 0, 0});
        break;
      case Interpolation::minimum_jerk:
        segments_.push_back({v0, 0, 0, 10 * d, -15 * d, 6 * d});
        break;
      case Interpolation::hold:
        segments_.push_back({v0, 0, 0, 0, 0, 0});
        break;
      case Interpolation::cubic:
      case Interpolation::spline:
        segments_.push_back(hermite(v0, v1, rates[i][0] * length, rates[i][1] * length));
        break;
    }
  }
}

// The index of the last key at or before t, which lies between the first and the last key. If keys
// are evenly spaced, it is found at once.
size_t Track::segment_at(double t) const {
  const double first = keys_.front().t;
  const double share = (t - first) / (keys_.back().t - first);
  const auto guess = static_cast<size_t>(share * static_cast<double>(segments_.size()));
  for (size_t i = guess > 0 ? guess - 1 : 0; i <= guess + 1 && i < segments_.size(); ++i)
    if (keys_[i].t <= t && t < keys_[i + 1].t) return i;
  const auto after = std::upper_bound(
      keys_.begin(), keys_.end(), t, [](double time, const TrackKey& key) { return time < key.t; });
  return static_cast<size_t>(after - keys_.begin()) - 1;
}

TrackPoint Track::at(double t) const {
  if (t <= keys_.front().t) return {keys_.front().value, 0, 0};
  if (t >= keys_.back().t) return {keys_.back().value, 0, 0};
  const size_t i = segment_at(t);
  const double length = keys_[i + 1].t - keys_[i].t;
  const double u = (t - keys_[i].t) / length;
  const auto& c = segments_[i];
  return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
          (c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])))) / length,
          (2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * 20 * c[5]))) / (length * length)};
}

}  // namespace ayumi
