// Motions with jumps and with rounded angles, which no smooth correction alone can mend.

#include "ayumi/repair/rough_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

namespace fs = std::filesystem;

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
  // All figures are changes from the given motion, and not from its smooth curves.
  EXPECT_GT(r.max_joint_change, everywhere ? 1e-4 : 0.05);
  EXPECT_DOUBLE_EQ(r.max_joint_change, r.moved.joint.size);
  EXPECT_DOUBLE_EQ(r.max_cog_change, r.moved.cog.size);
  EXPECT_EQ(r.where, r.moved.joints.front().joint);
  EXPECT_GT(r.change.change, 0);
  EXPECT_FALSE(r.before.consistent);
  pattern.correction = r.correction;
  EXPECT_EQ(repair(hoap1(), sample(hoap1(), pattern)).status, RepairStatus::already_consistent);
}

// The elbow of the walk jumps by 0.2 rad.
Pattern walk_with_jump() {
  Pattern pattern = walk_table();
  const int elbow = hoap1().find_dof("l_elbow");
  for_rows(*pattern.table, [&](double t, size_t k) {
    if (t > 1) pattern.table->theta(static_cast<Eigen::Index>(k), elbow) -= 0.2;
  });
  return pattern;
}

size_t windows_of(const CommandSeries& series, const RepairOptions& options = {}) {
  const ConsistencyReport check = check_consistency(hoap1(), series, options.check);
  EXPECT_FALSE(check.consistent);
  return rough_windows(hoap1(), series, check, options).size();
}

TEST(RoughMotion, AJumpOfAJointIsMended) { expect_mended(walk_with_jump(), false); }

TEST(RoughMotion, RoundedAnglesAreMended) {
  Pattern pattern = walk_table();
  for (double& angle : pattern.table->theta.reshaped()) angle = std::round(500 * angle) / 500;
  expect_mended(pattern, true);
}

// A table of angles alone, as robots and other programs record it. The COG, the ZMP and the force
// of the table are computed from the rough angles, so they must not judge the smooth curves.
TEST(RoughMotion, RoundedAnglesWithoutOtherColumnsAreMended) {
  Pattern pattern = walk_table();
  pattern.table->cog.clear();
  pattern.table->zmp.clear();
  pattern.table->fz.clear();
  for (double& angle : pattern.table->theta.reshaped()) angle = std::round(500 * angle) / 500;
  expect_mended(pattern, true);
}

TEST(RoughMotion, WhatIsLockedIsNotSmoothed) {
  RepairOptions options;
  options.locked_joints = {"l_elbow"};
  const RepairResult r = repair(hoap1(), sample(hoap1(), walk_with_jump()), options);
  EXPECT_EQ(r.status, RepairStatus::infeasible);
  EXPECT_TRUE(r.correction.smooth.empty());
}

TEST(RoughMotion, WhatIsTrustedIsNotSmoothed) {
  const CommandSeries series = sample(hoap1(), walk_with_jump());
  EXPECT_EQ(windows_of(series), 1u);
  RepairOptions options;
  for (const Trust trust : {Trust::cog, Trust::zmp}) {
    options.trust = trust;
    EXPECT_EQ(windows_of(series, options), 0u);
  }
}

// An arm that is only too fast, although it moves as smoothly as curves with these knots can do,
// has no jump.
TEST(RoughMotion, AMotionThatIsOnlyTooFastIsNotSmoothed) {
  for (const double width : {0.2, 0.3}) {
    Pattern pattern = walk_table();
    move_joint(hoap1(), *pattern.table, "l_shoulder_pitch", 0.8, 1, width);
    EXPECT_EQ(windows_of(sample(hoap1(), pattern)), 0u) << width;
  }
}

TEST(RoughMotion, AMotionThatFliesIsNotSmoothed) {
  CommandSeries series = sample(hoap1(), walk_with_jump());
  series.samples[300].support = Support::none;
  EXPECT_EQ(windows_of(series), 0u);
}

// The result in a file is the motion of the result.
TEST(RoughMotion, TheWindowsAreWrittenAndRead) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  CorrectionTrack& track = pattern.correction.emplace();
  track.spacing = 0.05;
  track.coefficients.setZero(4, 6);
  track.smooth = {{0.3, 0.7, 0.05}, {0.9, 1.6, 0.04}};
  const fs::path file = fs::path(testing::TempDir()) / "ayumi_smooth_windows.json";
  write_pattern(file, pattern);
  const CommandSeries a = sample(hoap1(), pattern), b = sample(hoap1(), read_pattern(file));
  for (size_t k = 0; k < a.samples.size(); ++k)
    ASSERT_EQ(a.samples[k].state.theta, b.samples[k].state.theta) << k;
}

// The elbow of the other arm is beyond its range, which one iteration cannot repair, with and
// without curves. The reasons are then about the motion as it was given, so no curve remains in the
// result.
TEST(RoughMotion, AFailureAfterSmoothingIsThatOfTheGivenMotion) {
  Pattern pattern = walk_with_jump();
  move_joint(hoap1(), *pattern.table, "r_elbow", 2.5, 2, 1);
  const CommandSeries series = sample(hoap1(), pattern);
  ASSERT_EQ(windows_of(series), 1u);
  RepairOptions options;
  options.max_iterations = 1;
  const RepairResult r = repair(hoap1(), series, options);
  ASSERT_NE(r.status, RepairStatus::repaired);
  EXPECT_TRUE(r.correction.smooth.empty());
}

}  // namespace
}  // namespace ayumi::test
