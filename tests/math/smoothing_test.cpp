#include "ayumi/math/smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ayumi::test {
namespace {

using Eigen::VectorXd;

double second(const VectorXd& x, Eigen::Index k) { return x[k + 1] - 2 * x[k] + x[k - 1]; }

double objective(const VectorXd& x, const VectorXd& y, double cutoff) {
  double sum = (y - x).squaredNorm();
  const double weight = std::pow(2 * M_PI * cutoff, -6);
  for (Eigen::Index k = 0; k + 3 < y.size(); ++k) {
    const double third = y[k + 3] - 3 * y[k + 2] + 3 * y[k + 1] - y[k];
    sum += weight * third * third;
  }
  return sum;
}

TEST(Smoothing, TakesRoundingAwayAndKeepsJumpsAndCurvature) {
  VectorXd truth(600), rounded(600);
  for (int k = 0; k < 600; ++k) {
    truth[k] = 400 * std::sin(0.01 * k) + (k >= 300 ? 300 : 0);
    rounded[k] = std::round(truth[k]);
  }
  const VectorXd smooth = smoothed_within(rounded, 20, 0.02);
  EXPECT_LE((smooth - rounded).cwiseAbs().maxCoeff(), 20);
  EXPECT_GE(smooth[300] - smooth[299], truth[300] - truth[299] - 2 * 20 - 1);
  double before = 0, after = 0;
  for (int k = 60; k < 240; ++k) {
    before = std::max(before, std::abs(second(rounded, k) - second(truth, k)));
    after = std::max(after, std::abs(second(smooth, k) - second(truth, k)));
  }
  EXPECT_GT(before, 0.5);
  EXPECT_LT(after, 0.05);
}

// A corner of 16 counts per sample, as real files have: within 21 counts it can be rounded over
// about 2 * 8 * 21 / 16 samples.
TEST(Smoothing, RoundsCornersAsFarAsTheBandGoes) {
  VectorXd corner(400);
  for (int k = 0; k < 400; ++k) corner[k] = k < 200 ? 0 : 16.0 * (k - 200);
  const VectorXd smooth = smoothed_within(corner, 21, 0.02);
  EXPECT_LE((smooth - corner).cwiseAbs().maxCoeff(), 21);
  double most = 0;
  for (int k = 2; k < 398; ++k) most = std::max(most, std::abs(second(smooth, k)));
  EXPECT_LT(most, 2.0);                    // the corner has 16
  EXPECT_GT(most, 16 * 16 / (16.0 * 21));  // no curve inside the band can bend less
}

// The result is an optimum: no feasible change makes it better.
TEST(Smoothing, NoChangeWithinTheBandIsBetter) {
  VectorXd x(120);
  for (int k = 0; k < 120; ++k) x[k] = std::round(30 * std::sin(0.05 * k)) + (k % 17 == 0 ? 3 : 0);
  const double band = 1.5, cutoff = 0.03;
  const VectorXd y = smoothed_within(x, band, cutoff);
  ASSERT_NEAR((y - x).cwiseAbs().maxCoeff(), band, 1e-3);
  const double least = objective(x, y, cutoff);
  for (int k = 0; k < 120; ++k)
    for (const double size : {-1e-2, 1e-2}) {
      VectorXd other = y;
      other[k] += size;
      if (std::abs(other[k] - x[k]) > band) continue;
      EXPECT_GT(objective(x, other, cutoff), least - 1e-4 * least) << k;
    }
}

TEST(Smoothing, LeavesStraightLinesAndShortSeriesAlone) {
  VectorXd line(50);
  for (int k = 0; k < 50; ++k) line[k] = 3 - 0.7 * k;
  EXPECT_LT((smoothed_within(line, 1, 0.02) - line).cwiseAbs().maxCoeff(), 1e-6);
  const VectorXd few = VectorXd::LinSpaced(7, 0, 1).array().square();
  EXPECT_EQ(smoothed_within(few, 1, 0.02), few);
  EXPECT_EQ(smoothed_within(line, 0, 0.02), line);
}

}  // namespace
}  // namespace ayumi::test
