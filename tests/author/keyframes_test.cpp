// Single keys, steps that alternate, motions in sequence that keep their keys, and loops.
#include <gtest/gtest.h>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/edit/gait_cycle.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

Keyframe key_of(double t) {
  Keyframe key;
  key.t = t;
  key.place.inside = "/keyframes";
  return key;
}

// The robot stands for 0.8 s, puts the right foot ahead, and stands for 0.8 s.
Pattern one_step() {
  Pattern p;
  p.robot = "hoap1";
  Swing swing;
  swing.foot = Side::right;
  swing.to.position = {0.02, -0.039, 0};
  swing.lift = 0.015;
  p.phases = {{0.8, Support::both, {}}, {1.2, Support::left, swing}, {2.0, Support::both, {}}};
  for (const double t : {0.0, 0.8, 1.2, 1.6}) {
    Keyframe key = key_of(t);
    key.zmp = ZmpKey{t == 0.8 || t == 1.2 ? ZmpKey::Place::left : ZmpKey::Place::center};
    if (t == 0.8) key.joints = {{"l_shoulder_pitch", 0.3}};
    p.keyframes.push_back(key);
  }
  return p;
}

TEST(KeyEdit, CopiesMovesAndMirrors) {
  const Pattern p = one_step();
  const Pattern copied =
      with_key_edited(hoap1(), p, {.at = 0.8, .to = 1.4, .copy = true, .mirror = true});
  ASSERT_EQ(copied.keyframes.size(), 5u);
  EXPECT_EQ(copied.keyframes[3].t, 1.4);
  EXPECT_EQ(copied.keyframes[3].zmp->place, ZmpKey::Place::right);
  EXPECT_EQ(copied.keyframes[3].joints.count("r_shoulder_pitch"), 1u);
  EXPECT_EQ(copied.keyframes[1].joints, p.keyframes[1].joints);
  // A key that arrives at the time of another is merged with it.
  const Pattern moved = with_key_edited(hoap1(), p, {.at = 0.8, .to = 1.2});
  ASSERT_EQ(moved.keyframes.size(), 3u);
  EXPECT_EQ(moved.keyframes[1].joints, p.keyframes[1].joints);
  EXPECT_NE(
      error_message([&] { with_key_edited(hoap1(), p, {.at = 0.5, .to = 1}); }, ErrorCode::usage)
          .find("there is no keyframe at 0.5 s. The times of the keyframes are 0, 0.8, 1.2, 1.6 s"),
      std::string::npos);
  EXPECT_NE(
      error_message([&] { with_key_edited(hoap1(), p, {.at = 0.8, .to = 2.5}); }, ErrorCode::usage)
          .find("the motion lasts from 0 to 2 s"),
      std::string::npos);
}

// In a VIIP phase, goals replace keys.
TEST(KeyEdit, ComesToNoTimeInsideAViipPhase) {
  Pattern p;
  p.robot = "hoap1";
  p.phases = {{1.0, Support::both, {}, {}}, {2.0, Support::both, {}, StepGoal{}}};
  p.phases.push_back({3.0, Support::both, {}, {}});
  p.keyframes = {key_of(0), key_of(0.5)};
  p.keyframes[1].joints = {{"l_elbow", -0.6}};
  for (const bool copy : {false, true})
    EXPECT_NE(
        error_message([&] { with_key_edited(hoap1(), p, {.at = 0.5, .to = 1.5, .copy = copy}); },
                      ErrorCode::usage)
            .find("phases/1: the keyframe would be at 1.5 s, inside the VIIP phase from 1 to "
                  "2 s"),
        std::string::npos);
  for (const double t : {1.0, 2.0, 2.5})
    EXPECT_EQ(with_key_edited(hoap1(), p, {.at = 0.5, .to = t}).keyframes.back().t, t);
}

TEST(Alternate, OneStepBecomesAWalk) {
  const Pattern p = one_step();
  const Pattern walk = alternated(hoap1(), p, 4);
  const FootPlan feet(hoap1(), walk);
  EXPECT_DOUBLE_EQ(feet.duration(), 8);
  const auto x = [&](Side side, double t) { return feet.pose(side, t).translation().x(); };
  const double start = x(Side::left, 0);
  // Each foot lands 20 mm ahead of the other one, and the last one beside it.
  EXPECT_NEAR(x(Side::right, 2) - start, 0.02, 1e-4);
  EXPECT_NEAR(x(Side::left, 4) - start, 0.04, 2e-4);
  EXPECT_NEAR(x(Side::right, 6) - start, 0.06, 3e-4);
  EXPECT_NEAR(x(Side::left, 8), x(Side::right, 8), 1e-9);
  EXPECT_NEAR(
      feet.pose(Side::left, 8).translation().y() - feet.pose(Side::right, 8).translation().y(),
      feet.pose(Side::left, 0).translation().y() - feet.pose(Side::right, 0).translation().y(),
      1e-9);
  const CommandSeries series = sample(hoap1(), walk, {.dt = 0.005});
  const auto arm = static_cast<Eigen::Index>(hoap1().find_dof("r_shoulder_pitch"));
  EXPECT_GT(std::abs(series.samples[560].state.theta[arm] - series.samples[0].state.theta[arm]),
            0.1);
  Pattern still = p;
  for (Phase& phase : still.phases) phase = {phase.until, Support::both, {}};
  EXPECT_NE(error_message([&] { alternated(hoap1(), still, 4); }, ErrorCode::bad_pattern)
                .find("no foot swings"),
            std::string::npos);
}

TEST(Chained, KeysInSequenceEndWhereTheSamplesEnd) {
  const RobotModel& model = hoap1();
  const Pattern walk = walk_pattern(model, {.steps = 2, .turn = 0.1}), bow = [&] {
    Pattern p;
    p.robot = "hoap1";
    p.cog_height = walk.cog_height;
    p.phases = {{2.0, Support::both, {}}};
    Keyframe begin = key_of(0), low = key_of(1), end = key_of(2);
    begin.zmp = low.zmp = end.zmp = ZmpKey{ZmpKey::Place::center};
    low.joints = {{"l_elbow", -0.6}};
    end.posture = "home";
    p.keyframes = {begin, low, end};
    return p;
  }();
  const CommandSeries a = sample(model, walk, {.dt = 0.005}), b = sample(model, bow, {.dt = 0.005});
  for (const double over : {0.0, 0.6}) {
    const Pattern keyed = chained(model, {walk, a}, {bow, b}, over);
    EXPECT_FALSE(keyed.table);
    const CommandSeries all = sample(model, keyed, {.dt = 0.005});
    EXPECT_NEAR(all.duration(), a.duration() + over + b.duration(), 0.011);
    // The arm of the second motion moves in its time, and the feet stay where the first ended.
    const auto elbow = static_cast<Eigen::Index>(model.find_dof("l_elbow"));
    const auto at = [&](double t) {
      return all.samples[static_cast<size_t>(std::lround(t / all.dt))].state.theta[elbow];
    };
    EXPECT_NEAR(at(walk.phases.back().until + over), model.rest_state().theta[elbow], 1e-9);
    EXPECT_NEAR(at(walk.phases.back().until + over + 1), -0.6, 1e-3);
    for (const size_t side : {0, 1})
      EXPECT_LT(
          (all.samples.back().feet[side].translation() - a.samples.back().feet[side].translation())
              .norm(),
          1e-6);
  }
}

Eigen::Isometry3d middle_of_feet(const CommandSample& sample) {
  Eigen::Isometry3d frame = sample.feet[0];
  frame.translation() = 0.5 * (sample.feet[0].translation() + sample.feet[1].translation());
  return frame;
}

// Two steps from the middle of a walk, in motion at both ends, follow each other without a
// discontinuity.
TEST(Loop, ACycleIsCutFromAWalk) {
  const RobotModel& model = hoap1();
  const Pattern walk = walk_pattern(model, {.steps = 8, .stride = 0.03, .period = 0.8});
  const CommandSeries series = sample(model, walk, {.dt = 0.005});
  const MotionPart whole{walk, series};
  const GaitCycle cycle = gait_cycle(model, whole, 2);
  ASSERT_TRUE(cycle.gap.closed);
  const CommandSeries closed = with_closed_cycle(series, cycle);
  const Pattern part = cut(model, {walk, closed}, cycle.begin, cycle.end, "cycle.csv");
  const CommandSeries once = sample(model, part, {.dt = 0.005});
  ASSERT_EQ(once.samples.size(), static_cast<size_t>(cycle.end - cycle.begin) + 1);
  EXPECT_GT(once.samples.front().state.dtheta.cwiseAbs().maxCoeff(), 0.1) << "it begins in motion";
  EXPECT_TRUE(loop_gap(model, {part, once}).closed);
  for (size_t k = 0; k < once.samples.size(); ++k) {
    const CommandSample& a = once.samples[k];
    const CommandSample& b = series.samples[static_cast<size_t>(cycle.begin) + k];
    EXPECT_LT((a.state.theta - b.state.theta).cwiseAbs().maxCoeff(), 2e-4) << k;
    EXPECT_LT((a.state.dtheta - b.state.dtheta).cwiseAbs().maxCoeff(), 0.02) << k;
    EXPECT_EQ(a.support, b.support) << k;
    EXPECT_LT((a.feet[0].translation() - b.feet[0].translation()).norm(), 1e-6) << k;
  }
  const Pattern twice = joined(model, {part, once}, {part, once}, 0, "twice.csv");
  const CommandSeries both = sample(model, twice, {.dt = 0.005});
  const double jump = [&] {
    double most = 0;
    for (size_t k = 1; k < both.samples.size(); ++k)
      most = std::max(
          most,
          (both.samples[k].state.dtheta - both.samples[k - 1].state.dtheta).cwiseAbs().maxCoeff());
    return most;
  }();
  double usual = 0;
  for (size_t k = 1; k < series.samples.size(); ++k)
    usual = std::max(usual, (series.samples[k].state.dtheta - series.samples[k - 1].state.dtheta)
                                .cwiseAbs()
                                .maxCoeff());
  EXPECT_LT(jump, 1.2 * usual);
  const LoopGap left = loop_gap(model, {part, once});
  EXPECT_LT(left.posture, 1e-12);
  EXPECT_LT(left.base, 1e-12);
  // At the join the ZMP is where it is in the walk.
  const auto zmp_at = [&](const CommandSeries& motion, long k) -> Eigen::Vector3d {
    const CommandSample& s = motion.samples[static_cast<size_t>(k)];
    return middle_of_feet(s).inverse() * s.zmp;
  };
  const long join = cycle.end - cycle.begin;
  for (const long k : {join - 1, join, join + 1})
    EXPECT_LT((zmp_at(both, k) - zmp_at(series, cycle.begin + k)).norm(), 5e-4) << k;
  EXPECT_NE(error_message([&] { cut(model, whole, cycle.begin, cycle.begin + 60, "x.csv"); },
                          ErrorCode::bad_pattern)
                .find("a foot is in the air"),
            std::string::npos);
}

TEST(Loop, SaysWhetherTheEndMeetsTheBeginning) {
  const RobotModel& model = hoap1();
  Pattern p;
  p.robot = "hoap1";
  p.phases = {{2.0, Support::both, {}}};
  Keyframe begin = key_of(0), raised = key_of(1);
  begin.zmp = ZmpKey{ZmpKey::Place::center};
  raised.joints = {{"l_elbow", -0.6}};
  p.keyframes = {begin, raised};
  const CommandSeries open = sample(model, p, {.dt = 0.005});
  const LoopGap gap = loop_gap(model, {p, open});
  EXPECT_FALSE(gap.closed);
  EXPECT_EQ(gap.joint, "l_elbow");
  EXPECT_NEAR(gap.posture, std::abs(-0.6 - model.rest_state().theta[model.find_dof("l_elbow")]),
              1e-3);
  Keyframe home = key_of(2);
  home.posture = "home";
  p.keyframes.push_back(home);
  const CommandSeries closed = sample(model, p, {.dt = 0.005});
  EXPECT_TRUE(loop_gap(model, {p, closed}).closed);
  // A motion that ends in the same posture, but with another joint rate, does not close.
  CommandSeries moving = closed;
  moving.samples.back().state.dtheta[model.find_dof("l_elbow")] = 0.5;
  EXPECT_FALSE(loop_gap(model, {p, moving}).closed);
}

}  // namespace
}  // namespace ayumi::test
