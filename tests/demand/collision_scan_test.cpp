// The scan's clearances of a motion agree with those of every pair at every sample.

#include "ayumi/demand/collision_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ayumi/dynamics/kinematics.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

constexpr double kExact = 0.002, kNear = 0.012;  // distances of the check [m]

// The robot hangs in the air. The right leg swings across the left one at `speed` [rad/s] and back
// again, the right arm waves, and everything else rests.
CommandSeries crossing(double speed) {
  CommandSeries series;
  series.dt = 0.001;
  const RobotModel& model = hoap1();
  for (int k = 0; k <= 800; ++k) {
    CommandSample sample;
    sample.state = model.rest_state();
    const double t = k * series.dt;
    sample.state.theta[model.find_dof("r_hip_roll")] += 0.35 * std::sin(speed / 0.35 * t);
    sample.state.theta[model.find_dof("r_shoulder_roll")] -= 0.3 * std::sin(7 * t);
    series.samples.push_back(sample);
  }
  return series;
}

TEST(CollisionScan, WhatIsNearIsExactAndTheRestAreLowerBounds) {
  const CollisionModel collisions(hoap1());
  ASSERT_GT(collisions.pairs().size(), 20u);
  for (const double speed : {0.3, 1.0, 3.0}) {
    const CommandSeries series = crossing(speed);
    RobotData data(hoap1());
    const auto pairs = static_cast<Eigen::Index>(collisions.pairs().size());
    Eigen::MatrixXd all(static_cast<Eigen::Index>(series.samples.size()), pairs);
    for (Eigen::Index k = 0; k < all.rows(); ++k) {
      update_positions(hoap1(), series.samples[static_cast<size_t>(k)].state, data);
      for (Eigen::Index p = 0; p < pairs; ++p)
        all(k, p) = collisions.clearance(collisions.pairs()[static_cast<size_t>(p)], data, 1e9);
    }
    double least = std::numeric_limits<double>::infinity();
    int last_pair = -1, last_sample = 0;
    size_t overlapping = 0;
    scan_clearance(hoap1(), series, collisions, kNear, kExact,
                   [&](int pair, int sample, double clearance) {
                     if (pair != last_pair) last_sample = -1;
                     EXPECT_GT(sample, last_sample) << pair;
                     last_pair = pair;
                     last_sample = sample;
                     least = std::min(least, clearance);
                     overlapping += clearance < 0;
                     if (clearance < kExact)
                       EXPECT_NEAR(clearance, all(sample, pair), 1e-12) << pair << " " << sample;
                     else
                       EXPECT_LE(clearance, all(sample, pair) + 1e-9) << pair << " " << sample;
                   });
    EXPECT_NEAR(least, all.minCoeff(), 1e-12) << speed;
    EXPECT_LT(least, 0) << speed;
    EXPECT_GT(overlapping, 0u) << speed;
  }
}

// Bodies that rest relative to each other are measured once: a robot that stands for ten seconds
// takes little more time than one that stands for one second.
TEST(CollisionScan, NothingIsMeasuredAgainWhereNothingMoves) {
  const CollisionModel collisions(hoap1());
  CommandSeries still;
  still.dt = 0.001;
  CommandSample sample;
  sample.state = hoap1().rest_state();
  still.samples.assign(1001, sample);
  std::vector<double> first(collisions.pairs().size(), 0);
  size_t notes = 0;
  scan_clearance(hoap1(), still, collisions, kNear, kExact, [&](int pair, int k, double clearance) {
    double& before = first[static_cast<size_t>(pair)];
    if (k == 0) before = clearance;
    EXPECT_EQ(clearance, before);
    ++notes;
  });
  EXPECT_EQ(notes, 51 * collisions.pairs().size());  // there is a note every 20 ms
}

}  // namespace
}  // namespace ayumi::test
