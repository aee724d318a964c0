#include "ayumi/study/subset_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/error_message.hpp"

namespace ayumi::test {
namespace {

/// The sum of n independent normal numbers is above beta sqrt(n) with the probability of a normal
/// number above beta: a closed form in any dimension.
double sum_of(const CaseNumbers& numbers) {
  double sum = 0;
  for (const double z : numbers.normal) sum += z;
  return sum / std::sqrt(static_cast<double>(numbers.normal.size()));
}

TEST(SubsetSimulation, FindsRareEventsOfAClosedForm) {
  for (const double exact : {0.2, 1e-2, 1e-3, 1e-5}) {
    const double beta = -normal_quantile(exact);
    double mean = 0;
    int covered = 0;
    constexpr int kStudies = 12;
    for (int study = 0; study < kStudies; ++study) {
      SubsetOptions options;
      options.seed = static_cast<std::uint64_t>(study + 1);
      const SubsetResult r = subset_simulation(20, sum_of, beta, 0.95, options);
      EXPECT_TRUE(r.reached);
      mean += r.probability / kStudies;
      covered += r.interval.low <= exact && exact <= r.interval.high;
      EXPECT_LE(r.runs, 6000);
    }
    // There are twelve studies of 1000 runs per level, whose variation is 0.2 to 0.4 at 1e-5.
    EXPECT_NEAR(mean / exact, 1, 0.3) << exact;
    // The interval is approximate: over 200 studies it covers in 90 % at 1e-5, in 95 % at 1e-3.
    EXPECT_GE(covered, 8) << exact;
  }
}

// The noise of the sensors is part of what is drawn: here it has half of the variance.
TEST(SubsetSimulation, DrawsNewNoiseToo) {
  const auto severity = [](const CaseNumbers& numbers) {
    const double u = (static_cast<double>(numbers.noise >> 11) + 0.5) * 0x1.0p-53;
    return (numbers.normal[0] + normal_quantile(u)) / std::sqrt(2.0);
  };
  double mean = 0;
  constexpr int kStudies = 12;
  for (int study = 0; study < kStudies; ++study) {
    SubsetOptions options;
    options.seed = static_cast<std::uint64_t>(study + 1);
    const SubsetResult r = subset_simulation(1, severity, -normal_quantile(1e-3), 0.95, options);
    EXPECT_TRUE(r.reached);
    mean += r.probability / kStudies;
  }
  EXPECT_NEAR(mean / 1e-3, 1, 0.3);
}

TEST(SubsetSimulation, DoesNotDependOnThreads) {
  SubsetOptions options;
  options.runs = 100;
  options.threads = 1;
  const SubsetResult one = subset_simulation(3, sum_of, 3.5, 0.95, options);
  options.threads = 3;
  const SubsetResult three = subset_simulation(3, sum_of, 3.5, 0.95, options);
  EXPECT_EQ(one.probability, three.probability);
  EXPECT_EQ(one.levels, three.levels);
  options.runs = 15;
  EXPECT_NE(error_message([&] { subset_simulation(3, sum_of, 3.5, 0.95, options); }).find("10"),
            std::string::npos);
}

TEST(SubsetSimulation, SaysWhenNothingFails) {
  SubsetOptions options;
  options.runs = 100;
  options.levels = 3;
  const SubsetResult r = subset_simulation(2, sum_of, 50, 0.95, options);
  EXPECT_FALSE(r.reached);
  // Equal severities make the shares larger than a tenth.
  EXPECT_LE(r.probability, 0.005);
}

}  // namespace
}  // namespace ayumi::test
