// Let e be the deviation of the DCM from the plan and w that of the ZMP. Then e' = omega (e - w)
// and e(T) = 0, and the integral of w^2 / 2 has to be as small as possible. The costate decays as
// exp(-omega t), so w = c exp(-omega t), and
//   e(T) = exp(omega T) (e(0) - c (1 - exp(-2 omega T)) / 2) = 0.
// With w(0) = c computed anew in every tick, e exp(-omega t) / (1 - exp(-2 omega (T - t))) stays
// constant, and e is 0 at T.
#include "ayumi/control/foot_guided.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

double foot_guided_gain(double omega, double time) {
  if (std::isinf(time)) return 2;
  return 2 / (1 - elementary::exp(-2 * omega * time));
}

FootGuided::FootGuided(const CommandSeries& series, double least_time)
    : dt_(series.dt), least_time_(least_time) {
  const std::vector<CommandSample>& s = series.samples;
  for (size_t k = 1; k < s.size(); ++k)
    for (Side side : {Side::left, Side::right})
      if (supports(s[k].support, side) && !supports(s[k - 1].support, side) &&
          (supports_.empty() || supports_.back() != static_cast<long>(k)))
        supports_.push_back(static_cast<long>(k));
}

double FootGuided::time_to_support(long k) const {
  const auto next = std::upper_bound(supports_.begin(), supports_.end(), k);
  return next == supports_.end() ? std::numeric_limits<double>::infinity()
                                 : dt_ * static_cast<double>(*next - k);
}

double FootGuided::gain(long k, double omega) const {
  return foot_guided_gain(omega, std::max(time_to_support(k), least_time_ / omega));
}

}  // namespace ayumi
