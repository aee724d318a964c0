// The same gains on gaits they were not chosen on: turning, sideways, a sudden stop, a slope with a
// push, the large robot. Actuators as they are.
#include <gtest/gtest.h>

#include "ayumi/io/pattern_file.hpp"
#include "ayumi/io/robot_file.hpp"
#include "ayumi/pattern/generate.hpp"
#include "ayumi/pattern/sample.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {
namespace {

const RobotModel& hoap1() {
  static const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  return model;
}

Disturbance push(double at, double angle, double impulse) {
  Disturbance d;
  d.at = at;
  d.duration = 0.02;
  d.direction = {std::cos(angle), std::sin(angle), 0};
  d.magnitude = impulse;
  return d;
}

/// Runs the pattern under DTAD.
SimulationResult run(const RobotModel& model, const Pattern& pattern,
                     const std::vector<Disturbance>& scenario, const World& world = {}) {
  SimulateOptions options;
  options.world = world;
  options.scenario = scenario;
  options.settle = 2;
  return simulate(model, sample(model, pattern), options).result;
}

void expect_stands(const SimulationResult& r, double final_error) {
  EXPECT_EQ(r.outcome, Outcome::stands) << "fell at " << r.fell_at;
  EXPECT_LE(r.final_cog_error, final_error);
  EXPECT_LE(r.max_torque_ratio, 1 + 1e-9);
}

/// In the middle of the fourth step: left foot down.
double middle_of_step(const Pattern& pattern) {
  return 0.5 * (pattern.phases[6].until + pattern.phases[7].until);
}

TEST(DtadGaits, Turning) {
  const Pattern pattern = walk_pattern(hoap1(), {.steps = 6, .turn = 0.15});
  expect_stands(run(hoap1(), pattern, {push(middle_of_step(pattern), M_PI / 2, 1.1)}), 0.002);
}

TEST(DtadGaits, Sideways) {
  const Pattern pattern = walk_pattern(hoap1(), {.steps = 6, .stride = 0, .side = 0.03});
  expect_stands(run(hoap1(), pattern, {push(middle_of_step(pattern), 0, 1.1)}), 0.002);
}

TEST(DtadGaits, SuddenStopWithTheFeetApart) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 8});
  pattern.phases.resize(8);  // ends with the fourth step in the air
  const double end = pattern.phases.back().until;
  std::erase_if(pattern.keyframes, [&](const Keyframe& key) { return key.t > end; });
  Keyframe stop = pattern.keyframes.back();
  stop.t = end + 0.15;
  stop.zmp = ZmpKey{ZmpKey::Place::center, Eigen::Vector2d::Zero()};
  pattern.keyframes.push_back(stop);
  pattern.phases.push_back({end + 1.2, Support::both, {}});
  expect_stands(run(hoap1(), pattern, {push(end + 0.05, 0, 1.1)}), 0.002);
}

TEST(DtadGaits, PushOnASlopeThatThePatternDoesNotKnow) {
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const double angle = 3 * M_PI / 180;
  for (const Eigen::Vector2d& slope : {Eigen::Vector2d(angle, 0), Eigen::Vector2d(0, -angle)}) {
    SCOPED_TRACE(slope.transpose());
    World world = pattern.world;
    world.slope = slope;
    expect_stands(run(hoap1(), pattern, pattern.scenario, world), 0.001);
  }
}

// What the servos received is what the table holds: played without control it moves the robot
// alike.
TEST(DtadGaits, TheExportedReferenceReplaysToTheSameLoci) {
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const CommandSeries series = sample(hoap1(), pattern);
  SimulateOptions options;
  options.world = pattern.world;
  const SimulationLog closed = simulate(hoap1(), series, options);
  const ReferenceTrajectory table = extract_reference(hoap1(), closed);
  ASSERT_EQ(table.rows.size(), closed.samples.size());
  CommandSeries replay = series;
  replay.samples.resize(table.rows.size(), series.samples.back());
  for (size_t k = 0; k < table.rows.size(); ++k) {
    replay.samples[k].state.theta = table.rows[k].theta;
    replay.samples[k].state.dtheta.setZero();  // the lead of the servos is in the table
  }
  replay.samples.front() = series.samples.front();  // held before both runs alike
  options.controller.type = "none";
  options.settle = 0;
  const SimulationLog open = simulate(hoap1(), replay, options);
  EXPECT_EQ(open.result.outcome, Outcome::stands);
  double cog = 0;
  for (size_t k = 0; k < std::min(open.samples.size(), closed.samples.size()); ++k)
    cog = std::max(cog, (open.samples[k].cog - closed.samples[k].cog).norm());
  EXPECT_LT(cog, 1e-5);
}

TEST(DtadGaits, TheLargeRobotWalksUnderItsPush) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/humanoid30");
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/humanoid30_walk.json");
  expect_stands(run(model, pattern, pattern.scenario, pattern.world), 0.003);
}

}  // namespace
}  // namespace ayumi
