// The 30-DOF robot is what its README says, and its generated patterns are sound.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {
namespace {

const RobotModel& robot(const std::string& name) {
  static const RobotModel hoap1 = load_robot("hoap1", {{AYUMI_SOURCE_DIR "/robots"}});
  static const RobotModel large = load_robot("humanoid30", {{AYUMI_SOURCE_DIR "/robots"}});
  return name == "hoap1" ? hoap1 : large;
}

TEST(Humanoid30, HasTheFiguresOfThePaper) {
  const RobotModel& model = robot("humanoid30");
  EXPECT_EQ(model.dof_count(), 30);
  EXPECT_EQ(model.leg(Side::left).size() + model.leg(Side::right).size(), 12u);
  int head = 0;
  for (const std::string& joint : model.dof_names())
    head += joint.starts_with("head_") || joint.starts_with("neck_");
  EXPECT_EQ(head, 4);
  EXPECT_NEAR(model.mass(), 35, 1e-9);
  EXPECT_NEAR(default_cog_height(model, {}), 0.600, 1e-5);
}

TEST(Humanoid30, IsSymmetric) {
  const RobotModel& model = robot("humanoid30");
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  EXPECT_NEAR(data.cog.y() - data.base_position.y(), 0, 1e-12);
}

class Generated : public testing::TestWithParam<std::string> {};

TEST_P(Generated, PatternsAreConsistent) {
  const RobotModel& model = robot(GetParam());
  WalkParameters in_place = walk_defaults(model);
  in_place.stride = 0;
  in_place.steps = 2;
  SwayParameters forward = sway_defaults(model);
  forward.forward = forward.side / 2;
  forward.side = 0;
  for (const Pattern& pattern :
       {walk_pattern(model, in_place), sway_pattern(model, sway_defaults(model)),
        sway_pattern(model, forward), squat_pattern(model, squat_defaults(model))}) {
    const ConsistencyReport report = check_consistency(model, sample(model, pattern));
    EXPECT_TRUE(report.consistent)
        << GetParam() << ", " << pattern.name << ": " << name_of(report.findings.front().kind)
        << " " << report.findings.front().where;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, Generated, testing::Values("hoap1", "humanoid30"));

}  // namespace
}  // namespace ayumi
