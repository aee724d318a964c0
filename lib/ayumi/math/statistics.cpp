#include "ayumi/math/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

namespace ayumi {

namespace {

/// This policy does not promote to long double, whose rounding depends on the processor.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Normal = boost::math::normal_distribution<double, Policy>;
using Beta = boost::math::beta_distribution<double, Policy>;
using Binomial = boost::math::binomial_distribution<double, Policy>;

/// Ranks count from 1; equal values get the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double mean = 0.5 * static_cast<double>(begin + end + 1);
    for (; begin < end; ++begin) result[order[begin]] = mean;
  }
  return result;
}

}  // namespace

double normal_quantile(double p) { return quantile(Normal(), p); }

double normal_probability(double z) { return cdf(Normal(), z); }

double upper_bound(long k, long n, double confidence) {
  if (k >= n) return 1;
  return quantile(Beta(static_cast<double>(k + 1), static_cast<double>(n - k)), confidence);
}

double lower_bound(long k, long n, double confidence) {
  if (k <= 0) return 0;
  return quantile(Beta(static_cast<double>(k), static_cast<double>(n - k + 1)), 1 - confidence);
}

RateInterval clopper_pearson(long k, long n, double confidence) {
  const double each = 0.5 * (1 + confidence);
  return {lower_bound(k, n, each), upper_bound(k, n, each)};
}

double mcnemar(long only_first, long only_second) {
  const long n = only_first + only_second;
  if (n == 0) return 1;
  const double tail = cdf(Binomial(static_cast<double>(n), 0.5),
                          static_cast<double>(std::min(only_first, only_second)));
  return std::min(1.0, 2 * tail);
}

RateInterval paired_difference(long only_first, long only_second, long pairs, double confidence) {
  const double each = 0.5 * (1 + confidence);
  const RateInterval first = clopper_pearson(only_first, pairs, each);
  const RateInterval second = clopper_pearson(only_second, pairs, each);
  return {first.low - second.high, first.high - second.low};
}

// The r-th smallest value is below the quantile exactly if at least r values are below it.
long quantile_bound_rank(long n, double q, double confidence) {
  if (n < 1) return 0;
  const Binomial below(static_cast<double>(n), q);
  for (long r = 1; r <= n; ++r)
    if (cdf(below, static_cast<double>(r - 1)) >= confidence) return r;
  return 0;
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const size_t n = std::min(x.size(), y.size());
  if (n < 2) return 0;
  const std::vector<double> a = ranks(x), b = ranks(y);
  const double mean = 0.5 * static_cast<double>(n + 1);
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < n; ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0.0;
}

}  // namespace ayumi
