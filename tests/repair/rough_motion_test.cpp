// Motions with jumps and with rounded angles, which no smooth correction alone can mend.

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

Pattern walk_table() {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  return baked(hoap1(), pattern);
}

// The result passes, and so does the pattern with the correction in it.
void expect_mended(Pattern pattern, bool everywhere) {
  const CommandSeries series = sample(hoap1(), pattern);
  ASSERT_FALSE(check_consistency(hoap1(), series).consistent);
  const RepairResult r = repair(hoap1(), series);
  ASSERT_EQ(r.status, RepairStatus::repaired) << (r.reasons.empty() ? "" : r.reasons[0]);
  ASSERT_EQ(r.correction.smooth.size(), 1u);
  const SmoothWindow& window = r.correction.smooth[0];
  EXPECT_EQ(window.end - window.begin > 0.99 * series.duration(), everywhere);
  pattern.correction = r.correction;
  EXPECT_EQ(repair(hoap1(), sample(hoap1(), pattern)).status, RepairStatus::already_consistent);
}

TEST(RoughMotion, AJumpOfAJointIsMended) {
  Pattern pattern = walk_table();
  const int elbow = hoap1().find_dof("l_elbow");
  for_rows(*pattern.table, [&](double t, size_t k) {
    if (t > 1) pattern.table->theta(static_cast<Eigen::Index>(k), elbow) -= 0.2;
  });
  expect_mended(pattern, false);
}

TEST(RoughMotion, RoundedAnglesAreMended) {
  Pattern pattern = walk_table();
  for (double& angle : pattern.table->theta.reshaped()) angle = std::round(500 * angle) / 500;
  expect_mended(pattern, true);
}

TEST(RoughMotion, WhatIsLockedIsNotSmoothed) {
  Pattern pattern = walk_table();
  const int elbow = hoap1().find_dof("l_elbow");
  for_rows(*pattern.table, [&](double t, size_t k) {
    if (t > 1) pattern.table->theta(static_cast<Eigen::Index>(k), elbow) -= 0.2;
  });
  RepairOptions options;
  options.locked_joints = {"l_elbow"};
  const RepairResult r = repair(hoap1(), sample(hoap1(), pattern), options);
  EXPECT_EQ(r.status, RepairStatus::infeasible);
  EXPECT_TRUE(r.correction.smooth.empty());
}

}  // namespace
}  // namespace ayumi::test
