// VIIP phases take no time from the keys: the posture is held during them.
#include "ayumi/plan/viip_phases.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

WalkParameters single_step_walk() {
  WalkParameters p;
  p.steps = 1;
  p.stride = 0.03;
  p.period = 0.6;
  return p;
}

// The walk, delayed by `wait`, after a VIIP phase of that length.
Pattern after_goal(Pattern walk, double wait) {
  for (Phase& phase : walk.phases) phase.until += wait;
  for (Keyframe& key : walk.keyframes) key.t += wait;
  walk.phases.insert(walk.phases.begin(), {wait, Support::both, {}, CogGoal{{0.01, 0, 0}}});
  return walk;
}

TEST(ViipPhases, GoalBeforeAWalkLeavesTheWalkAsItIs) {
  const RobotModel model = test::biped();
  const Pattern walk = walk_pattern(model, single_step_walk());
  const CommandSeries alone = sample(model, walk);
  const CommandSeries both = sample(model, after_goal(walk, 0.5));
  ASSERT_EQ(both.samples.size(), alone.samples.size() + 500);
  ASSERT_EQ(both.viip.size(), 1u);
  EXPECT_EQ(both.viip[0].begin, 0);
  EXPECT_EQ(both.viip[0].end, 500);
  for (size_t k = 0; k < alone.samples.size(); ++k) {
    const CommandSample &s = both.samples[k + 500], &t = alone.samples[k];
    ASSERT_LT((s.cog - t.cog).norm(), 1e-9) << k;
    ASSERT_LT((s.state.theta - t.state.theta).norm(), 1e-8) << k;
  }
  for (size_t k = 0; k < 500; ++k) {
    const CommandSample& s = both.samples[k];
    ASSERT_EQ(s.state.theta, both.samples[0].state.theta) << k;
    ASSERT_EQ(s.state.dtheta.norm(), 0) << k;
    ASSERT_EQ(s.fz, model.mass() * kGravity) << k;
  }
}

TEST(ViipPhases, APatternOfGoalsAloneStands) {
  const RobotModel model = test::biped();
  Pattern pattern;
  pattern.robot = "biped";
  pattern.phases = {{0.4, Support::both, {}, CogGoal{}}, {1.0, Support::both, {}, StepGoal{}}};
  const CommandSeries series = sample(model, pattern);
  EXPECT_EQ(series.samples.size(), 1001u);
  ASSERT_EQ(series.viip.size(), 2u);
  EXPECT_EQ(series.viip[1].begin, 400);
  EXPECT_EQ(series.viip[1].end, 1000);
}

std::string complaint(const Pattern& pattern) {
  try {
    sample(test::biped(), pattern);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ViipPhases, ComplaintsNameThePlace) {
  const RobotModel model = test::biped();
  const Pattern walk = walk_pattern(model, single_step_walk());
  Pattern keyed = after_goal(walk, 0.5);
  Keyframe key;
  key.t = 0.2;
  key.place.inside = "/keyframes/0";
  keyed.keyframes.insert(keyed.keyframes.begin(), key);
  EXPECT_NE(complaint(keyed).find("keyframes/0: the key at 0.2 s lies inside the VIIP phase"),
            std::string::npos);

  // The phase is inserted into the walk, first on one foot and then between its steps.
  Pattern broken = walk;
  const double on_one_foot = walk.phases[1].until;
  broken.phases.resize(2);
  broken.phases[1].until -= 0.1;
  broken.phases.push_back({on_one_foot + 2, Support::both, {}, CogGoal{}});
  while (broken.keyframes.back().t > broken.phases[1].until) broken.keyframes.pop_back();
  EXPECT_NE(complaint(broken).find("phases/2: the phase begins on one foot"), std::string::npos)
      << complaint(broken);
  Pattern moving = walk;
  moving.phases.insert(moving.phases.begin() + 3,
                       {walk.phases[2].until + 1, Support::both, {}, CogGoal{}});
  for (size_t i = 4; i < moving.phases.size(); ++i) moving.phases[i].until += 1;
  for (Keyframe& each : moving.keyframes)
    if (each.t > walk.phases[2].until - 1e-9) each.t += 1;
  EXPECT_NE(complaint(moving).find("phases/3: the phase begins while the COG moves"),
            std::string::npos)
      << complaint(moving);
}

}  // namespace
}  // namespace ayumi
