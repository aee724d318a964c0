#include "ayumi/math/bounded_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ayumi {
namespace {

using Eigen::VectorXd;

// If z = cos(v t), the bounded motion is x = cos(v t) / (1 + v^2 / w^2), far from the ends.
TEST(BoundedCog, CosineZmp) {
  const double w = 6.3, h = 0.005;
  for (const double v : {1.0, 5.0, 15.0}) {
    const int n = 2000;
    VectorXd z(n + 1);
    for (int k = 0; k <= n; ++k) z[k] = std::cos(v * h * k);
    const VectorXd x = bounded_cog(z, VectorXd::Constant(n + 1, w * w), h);
    for (int k = 800; k <= 1200; ++k)
      EXPECT_NEAR(x[k], z[k] / (1 + v * v / (w * w)), 2e-7) << "v " << v << " k " << k;
  }
}

// If z steps from 0 to 1 at t = 0, x is e^{wt}/2 before and 1 - e^{-wt}/2 after that.
TEST(BoundedCog, StepZmp) {
  const double w = 5, h = 0.001;
  const int n = 6000;
  VectorXd z(n + 1);
  for (int k = 0; k <= n; ++k) z[k] = k < n / 2 ? 0 : (k == n / 2 ? 0.5 : 1);
  const VectorXd x = bounded_cog(z, VectorXd::Constant(n + 1, w * w), h);
  for (int k = 0; k <= n; ++k) {
    const double t = h * (k - n / 2);
    EXPECT_NEAR(x[k], t < 0 ? 0.5 * std::exp(w * t) : 1 - 0.5 * std::exp(-w * t), 5e-6);
  }
}

// The differences of the solution satisfy x'' = w2 (x - z), also with a varying w2.
TEST(BoundedCog, MeetsThePendulumLaw) {
  const double h = 0.005;
  const int n = 600;
  VectorXd z(n + 1), w2(n + 1);
  for (int k = 0; k <= n; ++k) {
    z[k] = 0.04 * std::sin(4 * h * k);
    w2[k] = 40 + 8 * std::sin(3 * h * k);
  }
  const VectorXd x = bounded_cog(z, w2, h);
  EXPECT_EQ(x[0], z[0]);
  EXPECT_EQ(x[n], z[n]);
  for (int k = 2; k <= n - 2; ++k) {
    const double ddx =
        (-x[k - 2] + 16 * x[k - 1] - 30 * x[k] + 16 * x[k + 1] - x[k + 2]) / (12 * h * h);
    EXPECT_NEAR(ddx, w2[k] * (x[k] - z[k]), 2e-6);
  }
}

TEST(RestToRest, StartsAndEndsAtRestWithASmallBump) {
  const double w = 6.3, h = 0.005;
  const int n = 400;
  VectorXd z(n + 1);
  for (int k = 0; k <= n; ++k) z[k] = 0.04 * (k < 100 ? 0 : std::sin(3 * h * (k - 100)));
  const VectorXd w2 = VectorXd::Constant(n + 1, w * w);
  const RestToRest motion = RestToRestSolver(w2, h).solve(z);
  EXPECT_NEAR(motion.x[1] - motion.x[0], 0, 1e-8);
  EXPECT_NEAR(motion.x[n] - motion.x[n - 1], 0, 1e-6);
  // Without the bump the motion would start at about w * (anticipation) m/s.
  const VectorXd plain = bounded_cog(z, w2, h);
  EXPECT_GT(std::abs(plain[1] - plain[0]) / h, 1e-4);
  // A ZMP that already contains the bumps gives the same motion.
  VectorXd bumped = z;
  for (int k = 0; k <= n; ++k)
    bumped[k] +=
        motion.begin * rest_bump(w, h * k, h * n) + motion.end * rest_bump(w, h * (n - k), h * n);
  EXPECT_LT((bounded_cog(bumped, w2, h) - motion.x).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(RestToRest, LeavesAConstantAlone) {
  const RestToRest motion =
      RestToRestSolver(VectorXd::Constant(50, 40.0), 0.005).solve(VectorXd::Constant(50, 0.3));
  EXPECT_LT((motion.x.array() - 0.3).abs().maxCoeff(), 1e-14);
  EXPECT_NEAR(motion.begin, 0, 1e-10);
  EXPECT_NEAR(motion.end, 0, 1e-10);
}

}  // namespace
}  // namespace ayumi
