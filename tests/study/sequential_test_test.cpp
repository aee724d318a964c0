#include "ayumi/study/sequential_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ayumi/math/random.hpp"
#include "ayumi/math/statistics.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi::test {
namespace {

/// A made-up study: runs that fail with the probability p, until the test stops.
SequentialOutcome made_up(const SequentialTest& test, double p, ayumi::Random& random) {
  std::vector<bool> failed;
  SequentialOutcome outcome;
  while (!outcome.stopped) {
    for (int i = 0; i < 20; ++i) failed.push_back(random.uniform() < p);
    outcome = test.outcome(failed);
  }
  return outcome;
}

TEST(SequentialTest, StopsWithoutAFailureWhereClopperAndPearsonDo) {
  EXPECT_EQ(failure_free_runs(0.01, 0.95), 299);
  EXPECT_EQ(failure_free_runs(0.001, 0.95), 2995);
  EXPECT_EQ(failure_free_runs(0.5, 0.5), 1);
  const SequentialTest test(0.01, 0.95, 2990);
  std::vector<bool> good(400, false);
  const SequentialOutcome outcome = test.outcome(good);
  EXPECT_TRUE(outcome.stopped && outcome.certified);
  EXPECT_EQ(outcome.runs, 299);
  EXPECT_NEAR(test.upper_bound(outcome), upper_bound(0, 299, 0.95), 1e-12);
  EXPECT_EQ(test.lower_bound(outcome), 0);
  good[298] = true;
  EXPECT_FALSE(test.outcome(good).stopped);
}

TEST(SequentialTest, GivesUpWhenItIsHopeless) {
  const SequentialTest test(0.01, 0.95, 2990);
  const SequentialOutcome bad = test.outcome(std::vector<bool>(400, true));
  EXPECT_TRUE(bad.stopped);
  EXPECT_FALSE(bad.certified);
  EXPECT_EQ(bad.runs, static_cast<long>(test.plan().size()));
  EXPECT_EQ(test.upper_bound(bad), 1);
  EXPECT_GT(test.lower_bound(bad), 0.7);
  // With only as many runs as a certificate needs, the first failure ends the study.
  const SequentialTest short_test(0.01, 0.95, 299);
  std::vector<bool> one(299, false);
  one[41] = true;
  EXPECT_EQ(short_test.outcome(one).runs, 42);
  EXPECT_NE(error_message([] { SequentialTest(0.01, 0.95, 298); }).find("Give 299 or more"),
            std::string::npos);
}

// The error is bounded for the whole sequence of looks, and certificate and bound agree.
TEST(SequentialTest, ErrorIsBoundedOverAllLooks) {
  for (const double p0 : {0.001, 0.01, 0.05, 0.2})
    for (const double confidence : {0.8, 0.95, 0.99}) {
      const SequentialTest test(p0, confidence, 10 * failure_free_runs(p0, confidence));
      EXPECT_LE(test.power(p0), 1 - confidence);
      EXPECT_GT(test.power(p0), 0.5 * (1 - confidence));
      for (const double factor : {1.1, 2.0, 4.0})
        EXPECT_LT(test.power(p0 * factor), test.power(p0));
      for (size_t k = 0; k < test.plan().size(); ++k) {
        const long runs = test.plan()[k], failures = static_cast<long>(k);
        const SequentialOutcome outcome{true, true, runs, failures};
        EXPECT_LE(test.upper_bound(outcome), p0 * (1 + 1e-12));
        // Looking several times has a cost: the bound is never better than that of a fixed number
        // of runs.
        EXPECT_GE(test.upper_bound(outcome), upper_bound(failures, runs, confidence) * (1 - 1e-12));
      }
      const SequentialOutcome hopeless{true, false, test.plan().back(),
                                       static_cast<long>(test.plan().size())};
      EXPECT_GE(test.upper_bound(hopeless), p0);
    }
}

// The probability of a certificate is compared with a count over made-up studies.
TEST(SequentialTest, PowerAgreesWithMadeUpStudies) {
  const SequentialTest test(0.05, 0.95, 590);
  ayumi::Random random(3);
  for (const double p : {0.005, 0.02, 0.05}) {
    constexpr int kStudies = 4000;
    int certified = 0;
    for (int i = 0; i < kStudies; ++i) certified += made_up(test, p, random).certified;
    const double share = test.power(p);
    // The tolerance is four standard deviations of the counted share [1].
    EXPECT_NEAR(certified, kStudies * share, 4 * std::sqrt(kStudies * share * (1 - share)));
  }
}

// In 10,000 made-up studies for each failure probability, both bounds hold in 95 % or more.
TEST(SequentialTest, BoundsCoverInTenThousandMadeUpStudies) {
  const SequentialTest test(0.05, 0.95, 590);
  std::map<std::pair<long, long>, RateInterval> bounds;
  ayumi::Random random(11);
  for (const double p : {0.002, 0.01, 0.03, 0.0499, 0.05001, 0.08, 0.3}) {
    constexpr int kStudies = 10000;
    int above = 0, below = 0, wrong = 0;
    for (int i = 0; i < kStudies; ++i) {
      const SequentialOutcome outcome = made_up(test, p, random);
      const auto [place, fresh] = bounds.try_emplace({outcome.runs, outcome.failures});
      if (fresh) place->second = {test.lower_bound(outcome), test.upper_bound(outcome)};
      above += p <= place->second.high;
      below += p >= place->second.low;
      wrong += outcome.certified && p > test.failure();
    }
    // The tolerance is three standard deviations of a counted share of 95 % [1].
    const double least = kStudies * 0.95 - 3 * std::sqrt(kStudies * 0.95 * 0.05);
    EXPECT_GE(above, least) << p;
    EXPECT_GE(below, least) << p;
    EXPECT_LE(wrong, kStudies - least) << p;
  }
}

}  // namespace
}  // namespace ayumi::test
