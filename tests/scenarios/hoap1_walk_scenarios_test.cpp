// The walk of patterns/hoap1_walk.json under its push, on bad ground and with bad sensors, with the
// real actuators of HOAP-1. A user can rely on these limits.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/expect_stands.hpp"

namespace ayumi {
namespace {

using test::expect_stands;

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
  options.controller.type = controller_type(controller);
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

TEST(Hoap1Walk, StandsUnpushedWithAndWithoutControl) {
  for (const char* controller : {"none", "dtad"}) {
    SCOPED_TRACE(controller);
    const SimulationResult r = run(unpushed(controller));
    expect_stands(r, 0.002);
    EXPECT_LE(r.speed.ratio, 1.0);
    EXPECT_LE(r.final_speed, 0.001);
    EXPECT_GE(r.steps, 9);
  }
}

TEST(Hoap1Walk, PushFellsReplayAndTheLiteralLawButNotDtad) {
  expect_stands(run(pushed("dtad")), 0.002);
  EXPECT_EQ(run(pushed("none")).outcome, Outcome::fell);
  EXPECT_EQ(run(pushed("dtad-literal")).outcome, Outcome::fell);
}

/// The largest turn of an arm's joint against the plan [rad], if the standing robot is pushed to
/// the left so hard that no ZMP inside its soles holds it.
double arm_turn(const std::map<std::string, double>& weights, double t) {
  Pattern pattern = stand_pattern(walk().model, 2);
  Keyframe key;
  key.t = t;
  key.weights = weights;
  pattern.keyframes.push_back(key);
  const CommandSeries series = sample(walk().model, pattern);
  SimulateOptions options = unpushed("dtad");
  options.scenario = {{.at = 0.5,
                       .duration = 0.02,
                       .what = Push{.magnitude = 3.2, .direction = Eigen::Vector3d::UnitY()}}};
  const SimulationLog log = simulate(walk().model, series, options);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  double most = 0;
  for (const SimulationSample& s : log.samples)
    for (const char* joint : {"l_shoulder_roll", "r_shoulder_roll", "l_shoulder_twist"}) {
      const int j = walk().model.find_dof(joint);
      most = std::max(most, std::abs(s.reference_theta[j] - series.samples.front().state.theta[j]));
    }
  return most;
}

TEST(Hoap1Walk, ArmsTakeUpMomentumAsTheirWeightsInTheKeyframesSay) {
  const std::map<std::string, double> heavy = {{"l_shoulder_pitch", 1e6}, {"r_shoulder_pitch", 1e6},
                                               {"l_shoulder_roll", 1e6},  {"r_shoulder_roll", 1e6},
                                               {"l_shoulder_twist", 1e6}, {"r_shoulder_twist", 1e6},
                                               {"l_elbow", 1e6},          {"r_elbow", 1e6}};
  const double free = arm_turn({}, 0.1);
  EXPECT_GT(free, 0.1);
  EXPECT_LT(arm_turn(heavy, 0.1), 0.02 * free);
  EXPECT_GT(arm_turn(heavy, 1.5), 0.9 * free);  // after the push, the weights change nothing
}

// The angular momentum provides what the support cannot: 3.6 N s, 1.24 times the capture bound.
TEST(Hoap1Walk, StandsAPushThatNeedsAngularMomentum) {
  const CommandSeries series = sample(walk().model, stand_pattern(walk().model, 2));
  SimulateOptions options = unpushed("dtad");
  options.profile = "hoap1-strong";
  options.scenario = {{.at = 0.5,
                       .duration = 0.02,
                       .what = Push{.magnitude = 3.6, .direction = Eigen::Vector3d::UnitY()}}};
  EXPECT_EQ(simulate(walk().model, series, options).result.outcome, Outcome::stands);
  options.controller.gains = {{"momentum", 0}};
  EXPECT_EQ(simulate(walk().model, series, options).result.outcome, Outcome::fell);
}

// A push of 1.32 times the capture bound to either side. The trunk turns as far as the hips can,
// and slows down before one of them would stop it suddenly.
TEST(Hoap1Walk, StandsAPushToTheSideThatTheRangeOfTheHipsAllows) {
  const CommandSeries series = sample(walk().model, stand_pattern(walk().model, 3));
  SimulateOptions options = unpushed("dtad");
  options.profile = "hoap1-strong";
  for (const double side : {1.0, -1.0}) {
    SCOPED_TRACE(side);
    options.scenario = {
        {.at = 0.5, .duration = 0.02, .what = Push{.magnitude = 3.83, .direction = {0, side, 0}}}};
    EXPECT_EQ(simulate(walk().model, series, options).result.outcome, Outcome::stands);
  }
}

// A push of 1.5 times the capture bound backwards. The whole sole is needed until the DCM is inside
// it again, so the damping of the rocking must not keep the ZMP away from the edge.
TEST(Hoap1Walk, StandsAPushThatNeedsTheWholeSole) {
  const CommandSeries series = sample(walk().model, stand_pattern(walk().model, 3));
  SimulateOptions options = unpushed("dtad");
  options.profile = "hoap1-strong";
  options.scenario = {
      {.at = 0.5, .duration = 0.02, .what = Push{.magnitude = 3.02, .direction = {-1, 0, 0}}}};
  EXPECT_EQ(simulate(walk().model, series, options).result.outcome, Outcome::stands);
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

TEST(Hoap1Walk, PushWithSensorsThreeMillisecondsLate) {
  SimulateOptions options = pushed("dtad");
  options.scenario.push_back({.duration = 100, .what = Latency{0.003}});
  expect_stands(run(options), 0.002);
}

TEST(Hoap1Walk, PushWithAWeightInOneHand) {
  for (const char* hand : {"l_forearm", "r_forearm"}) {
    SCOPED_TRACE(hand);
    SimulateOptions options = pushed("dtad");
    options.scenario.push_back({.duration = 100, .what = Payload{.on = hand, .mass = 0.3}});
    expect_stands(run(options), 0.002);
  }
}

// A slope is a constant disturbance: the long-term term alone would answer it with a lasting
// offset, which the washout removes.
TEST(Hoap1Walk, SlopeThatThePatternDoesNotKnowInEveryDirection) {
  for (int i = 0; i < 8; ++i) {
    const double angle = i * M_PI / 4;
    SimulateOptions options = i % 2 == 0 ? pushed("dtad") : unpushed("dtad");
    options.world.slope = 3 * M_PI / 180 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    SCOPED_TRACE(options.world.slope.transpose());
    const SimulationResult r = run(options);
    EXPECT_EQ(r.outcome, Outcome::stands) << "fell at " << r.fell_at;
    EXPECT_LE(r.final_cog_error, 0.001);
  }
}

/// A plate of this height under the foothold of a swing. Swings are counted from 0.
GroundBlock plate(int swing, double height) {
  const Pattern& pattern = walk().pattern;
  for (const Phase& phase : pattern.phases) {
    if (!phase.swing || swing-- > 0) continue;
    GroundBlock block;
    block.low = phase.swing->to.position.head<2>() - Eigen::Vector2d(0.045, 0.0345);
    block.high = phase.swing->to.position.head<2>() + Eigen::Vector2d(0.059, 0.0345);
    block.height = height;
    return block;
  }
  return {};
}

/// The first touchdown of this side in a window [s]; -1 if there is none.
double touchdown(const SimulationLog& log, const char* side, double from, double to) {
  for (const SimulationEvent& event : log.events)
    if (event.kind == EventKind::touchdown && event.text.starts_with(side) && event.t >= from &&
        event.t <= to)
      return event.t;
  return -1;
}

// The plate makes the landing on it early, and the next landing, that of the other foot, late.
TEST(Hoap1Walk, LandingsEarlyAndLate) {
  const SimulationLog level = simulate(walk().model, walk().series, unpushed("dtad"));
  for (const double height : {0.0015, 0.003}) {
    SCOPED_TRACE(height);
    SimulateOptions options = unpushed("dtad");
    options.world.blocks.push_back(plate(2, height));  // the right foot, planned at 2.671 s
    const SimulationLog log = simulate(walk().model, walk().series, options);
    EXPECT_LE(touchdown(log, "right", 2.4, 2.9), touchdown(level, "right", 2.4, 2.9) - 0.02);
    EXPECT_GE(touchdown(log, "left", 2.95, 3.5), touchdown(level, "left", 2.95, 3.5) + 0.02);
    expect_stands(log.result, 0.001);
  }
}

/// The walk over discs of 3 mm, of which one to three are under every foothold, somewhere under the
/// sole.
SimulationResult over_discs(std::uint64_t seed) {
  Random random(seed);
  SimulateOptions options = unpushed("dtad");
  for (const Phase& phase : walk().pattern.phases) {
    if (!phase.swing) continue;
    for (std::uint64_t i = 0; i <= seed % 3; ++i) {
      GroundBlock disc;
      disc.kind = GroundBlock::Kind::disc;
      disc.center = phase.swing->to.position.head<2>() +
                    Eigen::Vector2d(0.007 + 0.049 * (2 * random.uniform() - 1),
                                    0.0315 * (2 * random.uniform() - 1));
      disc.radius = 0.005 + 0.015 * random.uniform();
      disc.height = 0.003;
      options.world.blocks.push_back(disc);
    }
  }
  return run(options);
}

TEST(Hoap1Walk, DiscsUnderEveryFoot) {
  for (std::uint64_t seed : {3, 6}) {
    SCOPED_TRACE(seed);
    const SimulationResult r = over_discs(seed);
    EXPECT_EQ(r.outcome, Outcome::stands) << "fell at " << r.fell_at;
  }
}

// A sole of 63 mm with one half on a plate of 3 mm leans by 5 deg, and with stiff ankles the trunk
// leans with it; a compliant ankle removes a part of that.
TEST(Hoap1Walk, AnkleGivesInOnHalfAPlate) {
  double conforming = 0, stiff = 0;
  for (int swing = 1; swing <= 4; ++swing) {
    SimulateOptions options = unpushed("dtad");
    options.profile = "hoap1-soft";  // on stiff servos, the robot falls with and without it
    options.controller.gains = {{"momentum", 0}};  // otherwise the law turns the trunk on purpose
    options.world.blocks.push_back(plate(swing, 0.003));
    options.world.blocks.back().low.y() += 0.0345;
    const SimulationResult soft = run(options);
    EXPECT_EQ(soft.outcome, Outcome::stands) << "fell at " << soft.fell_at;
    conforming += soft.max_tilt;
    options.controller.gains.emplace_back("conform", 0);
    stiff += run(options).max_tilt;
  }
  EXPECT_LT(conforming, 0.95 * stiff);
}

}  // namespace
}  // namespace ayumi
