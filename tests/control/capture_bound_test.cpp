// The capture bound agrees with closed forms: standing, one known change of support, and limits on
// one foot.
#include "ayumi/control/capture_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/model/gravity.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeight = 0.25;
const double kOmega = std::sqrt(kGravity / kHeight);
// Soles of test::biped(): x from -45 to 65 mm, half width 35 mm; feet at y = +-50 mm.
constexpr double kFront = 0.065, kBack = 0.045, kHalfWidth = 0.035, kFoot = 0.05;

CommandSample standing_sample(const RobotModel& model) {
  CommandSample s;
  s.state = model.rest_state();
  s.cog = Vector3d(0.01, 0, kHeight);
  s.zmp = Vector3d(0.01, 0, 0);
  s.feet[0].translation() = Vector3d(0, kFoot, 0);
  s.feet[1].translation() = Vector3d(0, -kFoot, 0);
  return s;
}

Vector2d towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

TEST(CaptureBound, StandingIsTheDistanceToTheEdge) {
  const RobotModel model = test::biped();
  CommandSeries series;
  series.samples.assign(200, standing_sample(model));
  const double unit = model.mass() * kOmega;
  const CaptureRegion region = capture_region(model, series, 30);
  EXPECT_NEAR(region.impulse_per_length, unit, 1e-12);
  EXPECT_NEAR(capture_bound(region, towards(0)), unit * (kFront - 0.01), 1e-9);
  EXPECT_NEAR(capture_bound(region, towards(M_PI)), unit * (kBack + 0.01), 1e-9);
  EXPECT_NEAR(capture_bound(region, towards(M_PI / 2)), unit * (kFoot + kHalfWidth), 1e-9);
  EXPECT_NEAR(capture_bound(region, towards(M_PI / 4)), unit * (kFront - 0.01) * std::sqrt(2.0),
              1e-9);
  for (int i = 0; i < 16; ++i) {
    const Vector2d u = towards(2 * M_PI * i / 16);
    EXPECT_NEAR(capture_bound(region, u), edge_bound(model, series, 30, u), 1e-9) << i;
  }
}

// With the left foot for T and then the right foot for ever,
//   h(n) = (1 - e^-wT) h_left(n) + e^-wT h_right(n).
TEST(CaptureBound, OneKnownStep) {
  const RobotModel model = test::biped();
  CommandSeries series;
  CommandSample s = standing_sample(model);
  s.feet[1].translation().x() = 0.08;
  s.support = Support::left;
  series.samples.assign(300, s);
  s.support = Support::right;
  series.samples.resize(500, s);
  const long k = 100;
  const double T = 0.001 * (300 - k), stay = 1 - std::exp(-kOmega * T);
  const double unit = model.mass() * kOmega;
  const CaptureRegion region = capture_region(model, series, k);
  EXPECT_NEAR(capture_bound(region, towards(0)), unit * (kFront + (1 - stay) * 0.08 - 0.01), 1e-9);
  EXPECT_NEAR(capture_bound(region, towards(M_PI / 2)),
              unit * (stay * kFoot - (1 - stay) * kFoot + kHalfWidth), 1e-9);
  EXPECT_NEAR(capture_bound(region, towards(-M_PI / 2)),
              unit * (kHalfWidth - stay * kFoot + (1 - stay) * kFoot), 1e-9);
  // The pendulum itself agrees. If it starts just inside the bound, with the ZMP held on the front
  // edge of each support in turn, its DCM ends inside the last one; if it starts just outside, it
  // does not.
  const double bound = capture_bound(region, towards(0)) / unit;
  for (double share : {0.99, 1.01}) {
    double dcm = 0.01 + share * bound;
    for (long j = k; j < 300; ++j) dcm += 0.001 * kOmega * (dcm - kFront);
    EXPECT_EQ(dcm < 0.08 + kFront, share < 1) << dcm;
  }
}

TEST(CaptureBound, FlightAddsTheCommandedPointAlone) {
  const RobotModel model = test::biped();
  CommandSeries series;
  CommandSample s = standing_sample(model);
  s.support = Support::none;
  series.samples.assign(10, s);
  const CaptureRegion region = capture_region(model, series, 0);
  EXPECT_NEAR(capture_bound(region, towards(1)), 0, 1e-12);
}

}  // namespace
}  // namespace ayumi
