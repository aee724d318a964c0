// The ZMP with which the COG of a plan sways least, for legs without the roll of the ankle.

#include "ayumi/repair/least_sway.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/plan/sample_plan.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

// The phases and the footholds of a walk, without keys of the ZMP.
Pattern plan_of_shuffle(const RobotModel& model, const WalkParameters& walk) {
  Pattern pattern = walk_pattern(model, walk);
  pattern.keyframes.assign(1, Keyframe());
  pattern.keyframes[0].posture = "home";
  return pattern;
}

// The largest distance of the COG from its first place, across the walk [m].
double sway_of(const CommandSeries& series) {
  double most = 0;
  for (const CommandSample& sample : series.samples)
    most = std::max(most, std::abs(sample.cog.y() - series.samples[0].cog.y()));
  return most;
}

TEST(LeastSway, StaysInsideTheSupportAndSwaysLess) {
  for (const double turn : {0.0, 0.1}) {
    const Pattern pattern = plan_of_shuffle(hoap1(), {.steps = 3, .stride = 0.02, .turn = turn});
    const CommandSeries plan = sample_plan(hoap1(), pattern);
    const auto zmp = zmp_of_least_sway(hoap1(), plan, 0.01);
    ASSERT_TRUE(zmp);
    for (size_t k = 0; k < plan.samples.size(); k += 10) {
      const CommandSample& sample = plan.samples[k];
      const double t = plan.dt * static_cast<double>(k);
      const SupportPlane plane = support_plane(hoap1(), sample.support, sample.feet);
      const Eigen::Vector3d at((*zmp)[0].at(t).value, (*zmp)[1].at(t).value, (*zmp)[2].at(t).value);
      EXPECT_GT(plane.polygon.margin((plane.frame.inverse() * at).head<2>()), 1e-3) << t;
    }
    const CommandSeries made = sample_plan(hoap1(), pattern, {}, {}, {.zmp = zmp});
    if (turn == 0) {
      EXPECT_LT(sway_of(made), 0.8 * sway_of(plan));
    }
    for (const size_t k : {size_t(0), plan.samples.size() - 1})
      EXPECT_LT((made.samples[k].cog - plan.samples[k].cog).norm(), 2e-3);
  }
}

// Each sample of a coarse plan is a point of the program, and steps of a finer one that do not
// divide 10 ms are whole samples.
TEST(LeastSway, WorksAtEveryServoPeriod) {
  for (const double dt : {0.02, 0.008, 0.004}) {
    const Pattern pattern = plan_of_shuffle(hoap1(), {.steps = 2, .stride = 0.02});
    const CommandSeries plan = sample_plan(hoap1(), pattern, {.dt = dt});
    EXPECT_TRUE(zmp_of_least_sway(hoap1(), plan, 0.01)) << dt;
  }
}

TEST(LeastSway, AFlightHasNone) {
  CommandSeries plan = sample_plan(hoap1(), plan_of_shuffle(hoap1(), {.steps = 1}));
  plan.samples[plan.samples.size() / 2].support = Support::none;
  EXPECT_FALSE(zmp_of_least_sway(hoap1(), plan, 0.01));
}

// The ankles have no roll, so that the legs carry the hips over the feet: only the lean of the
// trunk moves the COG aside, and not so far as a ZMP in the middle of the soles asks for.
TEST(FromScratch, ACogOfLeastSwayForLegsWithoutAnkleRoll) {
  RobotDescription robot = biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("ankle_roll")) joint.type = JointType::fixed;
  const RobotModel model(robot);
  const Pattern pattern = plan_of_shuffle(model, {.steps = 4,
                                                  .stride = 0.01,
                                                  .period = 0.5,
                                                  .double_support = 0.25,
                                                  .lift = 0.01,
                                                  .zmp_inwards = 0.02});
  const CommandSeries plan = sample_plan(model, pattern);
  ASSERT_FALSE(check_consistency(model, plan).consistent);
  const GeneratedMotion made = generate(model, pattern, plan, {});
  EXPECT_EQ(made.repair.status, RepairStatus::repaired)
      << (made.repair.reasons.empty() ? "" : made.repair.reasons[0]);
  EXPECT_TRUE(made.repair.check.consistent);
  EXPECT_TRUE(made.least_sway);
  EXPECT_EQ(made.cog, PlannedCog::keys);
  EXPECT_LT(sway_of(made.start), 0.7 * sway_of(plan));
}

}  // namespace
}  // namespace ayumi::test
