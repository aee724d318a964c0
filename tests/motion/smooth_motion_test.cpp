// Smooth curves in place of a part of a motion.

#include "ayumi/motion/smooth_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

CommandSeries walk() {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  return sample(hoap1(), pattern);
}

double largest_acceleration(const CommandSeries& series, int dof, double begin, double end) {
  double most = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = static_cast<double>(k) * series.dt;
    if (t >= begin && t <= end)
      most = std::max(most, std::abs(series.samples[k].acceleration[6 + dof]));
  }
  return most;
}

// A walk is a smooth motion, so curves with knots 50 ms apart change it little; at both ends of the
// window, place, speed and acceleration stay.
TEST(SmoothMotion, KeepsASmoothMotionAndItsEnds) {
  const CommandSeries series = walk();
  const CommandSeries smooth = smoothed(series, {{0.6, 1.7, 0.05}});
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const RobotState &a = series.samples[k].state, &b = smooth.samples[k].state;
    const double t = static_cast<double>(k) * series.dt;
    const double angle = (a.theta - b.theta).cwiseAbs().maxCoeff();
    EXPECT_LT(angle, t < 0.5995 || t > 1.7005 ? 1e-15 : 3e-3) << t;
    EXPECT_LT((a.base.position - b.base.position).norm(), 1e-3) << t;
    EXPECT_LT(a.base.attitude.angularDistance(b.base.attitude), 3e-3) << t;
  }
  for (const long k : {600L, 1700L}) {
    const CommandSample &a = series.samples[static_cast<size_t>(k)],
                        &b = smooth.samples[static_cast<size_t>(k)];
    EXPECT_LT((a.state.theta - b.state.theta).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((a.state.dtheta - b.state.dtheta).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(SmoothMotion, RemovesAJump) {
  CommandSeries series = walk();
  const int dof = hoap1().find_dof("l_elbow");
  for (size_t k = 1000; k < series.samples.size(); ++k) series.samples[k].state.theta[dof] -= 0.1;
  const CommandSeries smooth = smoothed(series, {{0.75, 1.25, 0.05}});
  EXPECT_LT(largest_acceleration(smooth, dof, 0, 9), 60);
  EXPECT_NEAR(smooth.samples[1300].state.theta[dof], series.samples[1300].state.theta[dof], 1e-15);
  EXPECT_NEAR(smooth.samples[700].state.theta[dof], series.samples[700].state.theta[dof], 1e-15);
}

// Angles that are rounded to 0.001 rad have accelerations of 1000 rad/s^2 at 1 kHz.
TEST(SmoothMotion, RemovesTheNoiseOfRoundedAngles) {
  CommandSeries series = walk();
  const CommandSeries exact = series;
  for (CommandSample& s : series.samples)
    for (double& angle : s.state.theta) angle = std::round(1000 * angle) / 1000;
  const CommandSeries smooth = smoothed(series, {{0, series.duration(), 0.05}});
  const int knee = hoap1().find_dof("r_knee");
  EXPECT_LT(largest_acceleration(smooth, knee, 0, 9),
            1.5 * largest_acceleration(exact, knee, 0, 9));
  for (size_t k = 0; k < series.samples.size(); ++k)
    EXPECT_NEAR(smooth.samples[k].state.theta[knee], exact.samples[k].state.theta[knee], 4e-3);
  EXPECT_LT(smooth.samples.front().state.dtheta.cwiseAbs().maxCoeff(), 1e-3);  // it begins at rest
}

// A motion that starts suddenly has large accelerations there. Curves in the middle change nothing
// of it.
TEST(SmoothMotion, KeepsTheRatesOutsideItsWindows) {
  CommandSeries series = walk();
  const int elbow = hoap1().find_dof("l_elbow");
  for (size_t k = 0; k < series.samples.size(); ++k)
    series.samples[k].state.theta[elbow] -= 0.2 * static_cast<double>(k) * series.dt;
  fill_rates(series.samples, series.dt, true);
  ASSERT_GT(std::abs(series.samples[0].acceleration[6 + elbow]), 50);
  const CommandSeries smooth = smoothed(series, {{0.6, 0.9, 0.05}, {0.9, 1.7, 0.05}});
  for (size_t k = 0; k < series.samples.size(); ++k) {
    if (k >= 599 && k <= 1701) continue;  // differences of fourth order reach two samples
    ASSERT_EQ(smooth.samples[k].acceleration, series.samples[k].acceleration) << k;
    ASSERT_EQ(smooth.samples[k].state.dtheta, series.samples[k].state.dtheta) << k;
  }
  CommandSeries anew = smooth;
  fill_rates(anew.samples, series.dt, true);
  for (size_t k = 0; k < series.samples.size(); ++k)
    ASSERT_EQ(smooth.samples[k].acceleration, anew.samples[k].acceleration) << k;
}

TEST(SmoothMotion, IsPartOfACorrection) {
  const CommandSeries series = walk();
  CorrectionTrack track;
  track.spacing = 0.05;
  track.coefficients.setZero(4, 6);
  track.smooth = {{0.6, 1.7, 0.05}};
  const CommandSeries corrected = apply_correction(hoap1(), series, track);
  const CommandSeries smooth = smoothed(series, track.smooth);
  for (size_t k = 0; k < series.samples.size(); ++k)
    ASSERT_EQ(corrected.samples[k].state.theta, smooth.samples[k].state.theta) << k;
}

}  // namespace
}  // namespace ayumi::test
