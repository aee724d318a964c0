// Patterns whose legs follow keys or a table: the base follows from the foot that carries.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

CommandSeries walk(const RobotModel& model) {
  WalkParameters p;
  p.steps = 3;
  return sample(model, walk_pattern(model, p));
}

// The joints of a solved walk as a table; its phases have no swings.
Pattern as_table(const RobotModel& model, const CommandSeries& series, bool with_base) {
  WalkParameters p;
  p.steps = 3;
  Pattern pattern = walk_pattern(model, p);
  pattern.keyframes.clear();
  for (Phase& phase : pattern.phases) phase.swing.reset();
  DenseTable table;
  table.file = "walk.csv";
  table.dt = series.dt;
  table.joints = model.dof_names();
  table.theta.resize(static_cast<Eigen::Index>(series.samples.size()), model.dof_count());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    table.theta.row(static_cast<Eigen::Index>(k)) = series.samples[k].state.theta.transpose();
    if (with_base) table.base.push_back(series.samples[k].state.base);
  }
  pattern.table = table;
  return pattern;
}

TEST(JointDriven, ATableOfASolvedWalkGivesTheWalkBack) {
  const RobotModel model = test::biped();
  const CommandSeries solved = walk(model);
  for (const bool with_base : {false, true}) {
    const CommandSeries replayed = sample(model, as_table(model, solved, with_base));
    ASSERT_EQ(replayed.samples.size(), solved.samples.size());
    for (size_t k = 0; k < solved.samples.size(); ++k) {
      const CommandSample& a = solved.samples[k];
      const CommandSample& b = replayed.samples[k];
      EXPECT_LT((a.state.theta - b.state.theta).norm(), 1e-12);
      EXPECT_LT((a.state.base.position - b.state.base.position).norm(), 1e-9);
      EXPECT_LT((a.cog - b.cog).norm(), 1e-9);
      if (k > 3 && k + 4 < solved.samples.size()) {
        EXPECT_LT((a.zmp - b.zmp).norm(), 5e-4);
        EXPECT_NEAR(a.fz, b.fz, 0.05);
      }
      for (const Side side : {Side::left, Side::right})
        EXPECT_LT((a.feet[static_cast<int>(side)].translation() -
                   b.feet[static_cast<int>(side)].translation())
                      .norm(),
                  1e-8);
    }
    EXPECT_NE(replayed.origin.at("joints").find("walk.csv"), std::string::npos);
  }
}

TEST(JointDriven, ATableAtAnotherRateIsTheSameMotion) {
  const RobotModel model = test::biped();
  const Pattern pattern = as_table(model, walk(model), true);
  const CommandSeries fine = sample(model, pattern),
                      coarse = sample(model, pattern, {.dt = 0.0025});
  for (size_t k = 0; k < coarse.samples.size() && 5 * k / 2 < fine.samples.size(); k += 2)
    EXPECT_LT((coarse.samples[k].cog - fine.samples[5 * k / 2].cog).norm(), 1e-10);
}

TEST(JointDriven, LegKeysKeepTheCarryingSoleAndCommandsStand) {
  const RobotModel model = test::biped();
  Pattern pattern;
  pattern.phases = {{2.0, Support::both, {}}};
  Keyframe key;
  key.t = 1.0;
  for (const char* side : {"l_", "r_"}) {
    key.joints[std::string(side) + "hip_pitch"] = -0.6;
    key.joints[std::string(side) + "knee"] = 1.2;
    key.joints[std::string(side) + "ankle_pitch"] = -0.6;
  }
  key.zmp = ZmpKey{ZmpKey::Place::point, Eigen::Vector2d(0.123, 0.0)};
  pattern.keyframes = {key};
  const CommandSeries series = sample(model, pattern);
  RobotData data(model);
  for (const CommandSample& now : series.samples) {
    update_positions(model, now.state, data);
    for (const Side side : {Side::left, Side::right})
      EXPECT_LT((sole_pose(model, data, side).matrix() -
                 series.samples[0].feet[static_cast<int>(side)].matrix())
                    .norm(),
                1e-9);
    EXPECT_LT((now.cog - data.cog).norm(), 1e-12);
  }
  // A given ZMP is kept: the check compares it with the full model.
  EXPECT_NEAR(series.samples.back().zmp.x(), 0.123, 1e-12);
  EXPECT_LT(series.samples.back().cog.z(), series.samples.front().cog.z() - 0.01);
}

TEST(JointDriven, PostureKeysAloneMoveTheLegs) {
  const RobotModel model = test::biped();
  Pattern pattern;
  pattern.phases = {{2.0, Support::both, {}}};
  Keyframe key;
  key.t = 1.0;
  key.posture = "squat";
  pattern.keyframes = {key};
  const CommandSeries series = sample(model, pattern);
  EXPECT_LT((series.samples.back().state.theta - model.posture("squat")).norm(), 1e-12);
  EXPECT_EQ(series.origin.at("joints").find("posture keys"), 0u);
  // If the body is given too, inverse kinematics determines the legs.
  pattern.keyframes[0].zmp = ZmpKey{ZmpKey::Place::center, Eigen::Vector2d::Zero()};
  const CommandSeries solved = sample(model, pattern);
  EXPECT_GT((solved.samples.back().state.theta - model.posture("squat")).norm(), 0.1);
}

TEST(JointDriven, ThePatternsOwnPosturesMayBePartial) {
  const RobotModel model = test::biped();
  Pattern pattern = stand_pattern(model, 2);
  pattern.postures["wave"] = {{"l_shoulder", -1.2}};
  Keyframe key;
  key.t = 1.0;
  key.posture = "wave";
  pattern.keyframes.push_back(key);
  const CommandSeries series = sample(model, pattern);
  EXPECT_NEAR(series.samples.back().state.theta[model.find_dof("l_shoulder")], -1.2, 1e-12);
  EXPECT_NEAR(series.samples.back().state.theta[model.find_dof("r_shoulder")], 0, 1e-12);
}

TEST(JointDriven, TheBaseNeverJumpsWhenTheFootChanges) {
  const RobotModel model = test::biped();
  Pattern pattern;
  pattern.phases = {{0.5, Support::both, {}}, {1.0, Support::left, {}}, {1.5, Support::right, {}}};
  Keyframe key;
  key.t = 1.2;
  key.joints["l_knee"] = 1.1;
  key.joints["r_hip_roll"] = -0.1;
  pattern.keyframes = {key};
  const CommandSeries series = sample(model, pattern);
  for (size_t k = 1; k < series.samples.size(); ++k)
    EXPECT_LT(
        (series.samples[k].state.base.position - series.samples[k - 1].state.base.position).norm(),
        1e-3);
}

}  // namespace
}  // namespace ayumi
