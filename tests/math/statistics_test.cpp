#include "ayumi/math/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/math/random.hpp"

namespace ayumi::test {
namespace {

/// The probability of at most k events in n runs, summed term by term.
double binomial(long k, long n, double p) {
  double sum = 0;
  for (long i = 0; i <= k; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    static_cast<double>(i) * std::log(p) +
                    static_cast<double>(n - i) * std::log1p(-p));
  return sum;
}

// The bounds are the probabilities for which the observed number is just likely enough.
TEST(Statistics, BoundsOfAProbabilityInvertTheBinomialDistribution) {
  for (const long n : {1L, 7L, 59L, 299L, 2995L})
    for (const long k : {0L, 1L, 3L, n / 2, n - 1, n}) {
      if (k > n) continue;
      const double upper = upper_bound(k, n, 0.95), lower = lower_bound(k, n, 0.95);
      if (k < n) {
        EXPECT_NEAR(binomial(k, n, upper), 0.05, 1e-9) << k << " of " << n;
      } else {
        EXPECT_EQ(upper, 1);
      }
      if (k > 0) {
        EXPECT_NEAR(1 - binomial(k - 1, n, lower), 0.05, 1e-9) << k << " of " << n;
      } else {
        EXPECT_EQ(lower, 0);
      }
    }
  // Closed form without a failure: 1 - 0.05^(1/n).
  EXPECT_NEAR(upper_bound(0, 299, 0.95), 1 - std::pow(0.05, 1.0 / 299), 1e-12);
  EXPECT_LT(upper_bound(0, 299, 0.95), 0.01);
  EXPECT_GT(upper_bound(0, 298, 0.95), 0.01);
  EXPECT_LT(upper_bound(0, 2995, 0.95), 0.001);
  EXPECT_GT(upper_bound(0, 2994, 0.95), 0.001);
}

TEST(Statistics, NormalQuantileAndProbabilityAreInverse) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  for (const double z : {-5.0, -1.0, 0.0, 0.3, 4.0})
    EXPECT_NEAR(normal_quantile(normal_probability(z)), z, 1e-9);
}

// The smallest rank whose chance of lying below the quantile is small enough, from the sum.
TEST(Statistics, QuantileBoundsNeedTheRunsOfACertificate) {
  EXPECT_EQ(quantile_bound_rank(298, 0.99, 0.95), 0);
  EXPECT_EQ(quantile_bound_rank(299, 0.99, 0.95), 299);
  for (const long n : {50L, 300L, 1000L}) {
    const long r = quantile_bound_rank(n, 0.9, 0.95);
    ASSERT_GT(r, 1);
    EXPECT_GE(binomial(r - 1, n, 0.9), 0.95);
    EXPECT_LT(binomial(r - 2, n, 0.9), 0.95);
  }
}

TEST(Statistics, QuantileBoundsHoldForAnyDistribution) {
  ayumi::Random random(5);
  const long n = 100, r = quantile_bound_rank(n, 0.95, 0.95);
  ASSERT_GT(r, 0);
  int covered = 0;
  constexpr int kStudies = 10000;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> values;
    for (long i = 0; i < n; ++i) values.push_back(std::exp(3 * random.normal()));
    std::sort(values.begin(), values.end());
    covered += values[static_cast<size_t>(r - 1)] >= std::exp(3 * normal_quantile(0.95));
  }
  // The tolerance is three standard deviations of the counted coverage [1].
  EXPECT_GE(covered, kStudies * (0.95 - 3 * std::sqrt(0.95 * 0.05 / kStudies)));
}

TEST(Statistics, McNemarIsTheSignTestOfTheDifferentPairs) {
  EXPECT_EQ(mcnemar(0, 0), 1);
  EXPECT_NEAR(mcnemar(0, 6), 2.0 / 64, 1e-12);
  EXPECT_NEAR(mcnemar(1, 9), 2.0 * 11 / 1024, 1e-12);
  EXPECT_EQ(mcnemar(9, 1), mcnemar(1, 9));
  EXPECT_EQ(mcnemar(5, 5), 1);
}

TEST(Statistics, IntervalOfAPairedDifferenceCovers) {
  ayumi::Random random(7);
  // Probabilities of a pair: only the first fails, only the second fails.
  for (const auto& [first, second] : {std::pair(0.02, 0.01), std::pair(0.3, 0.1)}) {
    int covered = 0;
    constexpr int kStudies = 2000;
    for (int study = 0; study < kStudies; ++study) {
      long b = 0, c = 0;
      for (int i = 0; i < 200; ++i) {
        const double u = random.uniform();
        b += u < first;
        c += u >= first && u < first + second;
      }
      const RateInterval interval = paired_difference(b, c, 200, 0.95);
      covered += interval.low <= first - second && first - second <= interval.high;
    }
    EXPECT_GE(covered, 0.95 * kStudies);
  }
}

TEST(Statistics, RankCorrelationSeesOrderAlone) {
  const std::vector<double> x = {1, 2, 3, 4, 5}, cubes = {1, 8, 27, 64, 125};
  EXPECT_NEAR(rank_correlation(x, cubes), 1, 1e-12);
  EXPECT_NEAR(rank_correlation({5, 4, 3, 2, 1}, cubes), -1, 1e-12);
  EXPECT_EQ(rank_correlation({1, 1, 1}, {1, 2, 3}), 0);
  // 1 - 6 sum d^2 / (n (n^2 - 1)) without ties.
  EXPECT_NEAR(rank_correlation(x, {2, 1, 4, 3, 5}), 1 - 6.0 * 4 / (5 * 24), 1e-12);
  // Ties share the mean rank: ranks 1.5 1.5 3 against 1 2 3.
  EXPECT_NEAR(rank_correlation({7, 7, 9}, {1, 2, 3}), 1.5 / std::sqrt(1.5 * 2), 1e-12);
}

}  // namespace
}  // namespace ayumi::test
