// Walks with a planted fault are repaired and played in open loop: in an independent integrator,
// with servos that sag, the robot stands at the end.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/repair/repair.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

Pattern table_of(const WalkParameters& parameters) {
  Pattern pattern = walk_pattern(hoap1(), parameters);
  pattern.robot = "hoap1";
  return baked(hoap1(), pattern);
}

// The middle one of the phases with a swing.
size_t middle_step(const Pattern& pattern) {
  const size_t middle = pattern.phases.size() / 2;
  return pattern.phases[middle].swing ? middle : middle + 1;
}

void expect_stands_repaired(const Pattern& pattern, const std::string& profile) {
  RepairOptions options;
  options.check.profile = profile;
  const RepairResult r = repair(hoap1(), sample(hoap1(), pattern), options);
  ASSERT_EQ(r.status, RepairStatus::repaired);
  SimulateOptions open_loop;
  open_loop.controller.type = ControllerKind::none;
  open_loop.profile = profile;
  open_loop.plant = mujoco_plant_kind();
  const SimulationResult result = simulate(hoap1(), r.series, open_loop).result;
  EXPECT_EQ(result.outcome, Outcome::stands) << "fell at " << result.fell_at << " s";
  EXPECT_LT(result.final_cog_error, 0.002);
}

// The walk goes sideways, 15 mm per step; the foot has to come down 60 ms earlier.
TEST(RepairedWalk, StandsAfterAnEarlyContact) {
  Pattern pattern = table_of({.steps = 9, .stride = 0, .side = 0.03});
  pattern.phases[middle_step(pattern)].until -= 0.06;
  expect_stands_repaired(pattern, "hoap1-strong");
}

// The knee of the swinging leg is moved by 70 degrees, beyond its limit, in a walk that turns by 8
// degrees per step.
TEST(RepairedWalk, StandsAfterAThrownKnee) {
  Pattern pattern = table_of({.steps = 8, .stride = 0.02, .period = 0.7, .turn = 8 * M_PI / 180});
  const size_t step = middle_step(pattern);
  const Phase& phase = pattern.phases[step];
  const double middle = 0.5 * (pattern.phases[step - 1].until + phase.until);
  move_joint(hoap1(), *pattern.table, phase.swing->foot == Side::left ? "l_knee" : "r_knee",
             70 * M_PI / 180, middle, 0.4);
  expect_stands_repaired(pattern, "hoap1-strong");
}

// The walks are in place and sideways, with the whole motion in 0.62 of its time: a knee is too
// fast.
TEST(RepairedWalk, StandsInLessTime) {
  Pattern pattern = table_of({.steps = 8, .stride = 0.02, .period = 0.7, .side = 0.016});
  squeeze(pattern, 0.62);
  expect_stands_repaired(pattern, "hoap1");
}

}  // namespace
}  // namespace ayumi::test
