// Walks in parts, and the cycle of two steps in the middle of a walk.

#include "ayumi/author/edit/gait_cycle.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/walk_in_parts.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

TEST(GaitCycle, TwoStepsMoveAndTurnAsTheParametersSay) {
  Random random(7);
  for (int trial = 0; trial < 3; ++trial) {
    WalkParameters p;
    p.steps = 8;
    p.stride = 0.02 + 0.02 * random.uniform();
    p.side = 0.02 * random.uniform();
    p.turn = 0.1 * random.uniform();
    const Pattern pattern = walk_in_parts(hoap1(), {p}, 7);
    const CommandSeries series = sample(hoap1(), pattern);
    const GaitCycle cycle = gait_cycle(hoap1(), {pattern, series}, 4);
    EXPECT_EQ(cycle.end - cycle.begin, std::lround(2 * p.period / series.dt));
    EXPECT_EQ(cycle.first, Side::right);
    EXPECT_NEAR(cycle.turn, 2 * p.turn, 2e-4);
    // The middle of the feet goes round an arc: two strides and one step to the side. Footholds are
    // rounded to 0.1 mm.
    const double across = cycle.displacement.norm();
    EXPECT_NEAR(across, std::hypot(2 * p.stride, p.side), 0.1 * p.turn * p.side + 1e-3);
    EXPECT_TRUE(cycle.gap.closed) << cycle.gap.posture << " rad, " << cycle.gap.rate << " rad/s";
  }
}

TEST(GaitCycle, AWalkThatIsTooShortIsRefused) {
  WalkParameters p;
  p.steps = 3;
  const Pattern pattern = walk_pattern(hoap1(), p);
  const CommandSeries series = sample(hoap1(), pattern);
  EXPECT_THROW(gait_cycle(hoap1(), {pattern, series}, 2), Error);
}

TEST(WalkInParts, HasTheStepsOfItsParts) {
  WalkParameters slow, fast;
  slow.steps = 3;
  fast.steps = 2;
  slow.stride = 0.02;
  fast.stride = 0.04;
  fast.period = 0.5;
  const Pattern both = walk_in_parts(hoap1(), {slow, fast});
  std::vector<double> places, times;
  for (const Phase& phase : both.phases)
    if (phase.swing) {
      places.push_back(phase.swing->to.position.x());
      times.push_back(phase.until);
    }
  const std::vector<double> wanted = {0.02, 0.04, 0.06, 0.10, 0.14, 0.14};
  ASSERT_EQ(places.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(places[i] - places[0], wanted[i] - 0.02, 1e-9);
  EXPECT_NEAR(times[2] - times[1], slow.period, 1e-9);
  EXPECT_NEAR(times[4] - times[3], fast.period, 1e-9);
  // A walk of one part is the same as the walk without parts.
  const Pattern one = walk_in_parts(hoap1(), {slow}), same = walk_pattern(hoap1(), slow);
  ASSERT_EQ(one.phases.size(), same.phases.size());
  for (size_t i = 0; i < one.phases.size(); ++i)
    EXPECT_EQ(one.phases[i].until, same.phases[i].until);
}

TEST(WalkInParts, RefusesPartsThatDoNotFit) {
  WalkParameters a, b;
  b.cog_height = 0.24;
  EXPECT_THROW(walk_in_parts(hoap1(), {a, b}), Error);
  EXPECT_THROW(walk_in_parts(hoap1(), {}), Error);
  WalkParameters stairs = stair_defaults(hoap1(), 0.01);
  stairs.cog_height = 0;
  EXPECT_THROW(walk_in_parts(hoap1(), {a, stairs}), Error);
}

}  // namespace
}  // namespace ayumi
