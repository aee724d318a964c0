// The walk of patterns/hoap1_walk.json under its push, on bad ground and with bad sensors, on the
// real actuators of HOAP-1. The limits are those a user relies on.
#include <gtest/gtest.h>

#include "ayumi/io/pattern_file.hpp"
#include "ayumi/io/robot_file.hpp"
#include "ayumi/pattern/sample.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {
namespace {

struct Walk {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  CommandSeries series = sample(model, pattern);
};

const Walk& walk() {
  static const Walk w;
  return w;
}

SimulateOptions unpushed(const std::string& controller) {
  SimulateOptions options;
  options.controller.type = controller;
  options.profile = "hoap1";
  options.world = walk().pattern.world;
  return options;
}

SimulateOptions pushed(const std::string& controller) {
  SimulateOptions options = unpushed(controller);
  options.scenario = walk().pattern.scenario;
  return options;
}

SimulationResult run(const SimulateOptions& options) {
  return simulate(walk().model, walk().series, options).result;
}

void expect_stands(const SimulationResult& r, double final_error) {
  EXPECT_EQ(r.outcome, Outcome::stands) << "fell at " << r.fell_at;
  EXPECT_LE(r.final_cog_error, final_error);
  EXPECT_LE(r.max_torque_ratio, 1 + 1e-9);
}

TEST(Hoap1Walk, StandsUnpushedWithAndWithoutControl) {
  for (const char* controller : {"none", "dtad"}) {
    SCOPED_TRACE(controller);
    const SimulationResult r = run(unpushed(controller));
    expect_stands(r, 0.002);
    EXPECT_LE(r.max_speed_ratio, 1.0);
    EXPECT_LE(r.final_speed, 0.001);
    EXPECT_GE(r.steps, 9);
  }
}

TEST(Hoap1Walk, PushFellsReplayAndTheLiteralLawButNotDtad) {
  expect_stands(run(pushed("dtad")), 0.002);
  EXPECT_EQ(run(pushed("none")).outcome, Outcome::fell);
  EXPECT_EQ(run(pushed("dtad-literal")).outcome, Outcome::fell);
}

TEST(Hoap1Walk, PushOnSlipperyGround) {
  SimulateOptions options = pushed("dtad");
  options.world.friction = 0.4;
  expect_stands(run(options), 0.002);
}

TEST(Hoap1Walk, PushWithNoisyLateSensors) {
  SimulateOptions options = pushed("dtad");
  options.sensor_noise = true;
  for (std::uint64_t seed : {1, 2}) {
    options.seed = seed;
    SCOPED_TRACE(seed);
    expect_stands(run(options), 0.003);
  }
}

// A slope is a constant disturbance: what the long-term term alone would answer with a lasting
// offset, the washout forgets.
TEST(Hoap1Walk, SlopeThatThePatternDoesNotKnow) {
  const double angle = 3 * M_PI / 180;
  for (const Eigen::Vector2d& slope : {Eigen::Vector2d(angle, 0), Eigen::Vector2d(-angle, 0),
                                       Eigen::Vector2d(0, angle), Eigen::Vector2d(0, -angle)}) {
    SimulateOptions options = unpushed("dtad");
    options.world.slope = slope;
    options.settle = 3.0;
    SCOPED_TRACE(slope.transpose());
    const SimulationResult r = run(options);
    EXPECT_EQ(r.outcome, Outcome::stands) << "fell at " << r.fell_at;
    EXPECT_LE(r.final_cog_error, 0.001);
  }
}

}  // namespace
}  // namespace ayumi
