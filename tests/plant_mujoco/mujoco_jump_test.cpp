// The jumps of HOAP-1 in MuJoCo: an independent integrator and softer ground under the same law.
#include <gtest/gtest.h>

#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#include "tests/support/jump_figures.hpp"

namespace ayumi {
namespace {

constexpr double kRef = 0.22;  // ref z_G of the pattern [m]

TEST(MujocoJump, RisesAsPlannedLandsAndSettles) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_jump.json");
  JumpGoal& goal = std::get<JumpGoal>(*pattern.phases[1].viip);
  SimulateOptions options;
  options.controller = pattern.controller;
  options.profile = pattern.profile;
  options.plant = mujoco_plant_kind();
  using Release = JumpGoal::Release;
  for (const auto& [height, stoop, release] : {std::tuple{0.02, 0.04, Release::ref_z},
                                               {0.05, 0.035, Release::ref_z},
                                               {0.045, 0.04, Release::spring}}) {
    SCOPED_TRACE(testing::Message() << height << " " << stoop);
    goal.height = height;
    goal.stoop = stoop;
    goal.release = release;
    const SimulationLog log = simulate(model, sample(model, pattern), options);
    const auto jumps = test::jumps_of(model, log, kRef);
    ASSERT_EQ(jumps.size(), 1u);
    const double apex = height + (release == Release::spring ? stoop * stoop / (4 * height) : 0.0);
    EXPECT_NEAR(jumps[0].apex, apex, 0.05 * apex);
    EXPECT_NEAR(jumps[0].stoop, stoop, 0.15 * stoop);
    EXPECT_GT(jumps[0].clearance, 0.003);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_LT(test::settled_at(log, kRef, 0.003), jumps[0].lift_off + 1.0);
    EXPECT_LT(test::feet_drift(model, log, Eigen::Vector2d::Zero()), 0.010);
  }
}

}  // namespace
}  // namespace ayumi
