// The same gains on gaits for which they were not chosen: turning, sideways, a sudden stop, a slope
// with a push, the large robot. Actuators are unchanged.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/expect_stands.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::expect_stands;
using test::hoap1;

Disturbance push(double at, double angle, double impulse) {
  return {.at = at,
          .duration = 0.02,
          .what = Push{.magnitude = impulse, .direction = {std::cos(angle), std::sin(angle), 0}}};
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

/// The time in the middle of the fourth step, with the left foot down.
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

TEST(DtadGaits, ClimbingStairsOfTenMillimetres) {
  const Pattern pattern = walk_pattern(hoap1(), stair_defaults(hoap1(), 0.01));
  ASSERT_EQ(pattern.world.blocks.size(), 3u);
  EXPECT_NEAR(pattern.world.blocks.back().height, 0.03, 1e-12);
  const CommandSeries series = sample(hoap1(), pattern);
  EXPECT_NEAR(series.samples.back().cog.z() - series.samples.front().cog.z(), 0.03, 1e-6);
  for (const char* profile : {"hoap1", "hoap1-strong"}) {
    SCOPED_TRACE(profile);
    SimulateOptions options;
    options.profile = profile;
    options.world = pattern.world;
    options.scenario = {push(middle_of_step(pattern), M_PI / 2, 1.1)};
    const SimulationLog log = simulate(hoap1(), series, options);
    expect_stands(log.result, 0.002);
    EXPECT_NEAR(log.samples.back().cog.z(), series.samples.back().cog.z(), 0.002);
  }
}

TEST(DtadGaits, SuddenStopWithTheFeetApart) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 8});
  pattern.phases.resize(8);  // it ends with the fourth step in the air
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

/// The largest distance between the loci of two runs [m].
double apart(const SimulationLog& a, const SimulationLog& b) {
  double most = 0;
  for (size_t k = 0; k < std::min(a.samples.size(), b.samples.size()); ++k)
    most = std::max(most, (a.samples[k].cog - b.samples[k].cog).norm());
  return most;
}

// The table contains what the servos received. As the table of a pattern, it moves the robot in the
// same way without control: the lead of the servos is not added twice.
TEST(DtadGaits, TheExportedReferenceReplaysToTheSameLoci) {
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const CommandSeries series = sample(hoap1(), pattern);
  SimulateOptions options;
  options.world = pattern.world;
  options.settle = 0;
  const SimulationLog closed = simulate(hoap1(), series, options);
  const test::TemporaryFolder folder;
  write_file(folder.path() / "reference.csv", reference_csv(extract_reference(hoap1(), closed)));
  Pattern replay = pattern;
  replay.keyframes.clear();
  replay.table = read_dense_table(folder.path() / "reference.csv");
  EXPECT_TRUE(replay.table->commands);
  options.controller.type = ControllerKind::none;
  const CommandSeries played = sample(hoap1(), replay);
  const SimulationLog open = simulate(hoap1(), played, options);
  EXPECT_EQ(open.result.outcome, Outcome::stands);
  EXPECT_LT(apart(closed, open), 5e-5);
  // The postures behind the table are those of the reference: its COG is that of the posture.
  RobotData data(hoap1());
  for (const CommandSample& s : played.samples) {
    update_positions(hoap1(), s.state, data);
    EXPECT_LT((data.cog - s.cog).norm(), 1e-3);
  }
  // If it is taken for postures, the lead is added to the same table twice.
  replay.table->commands = false;
  EXPECT_GT(apart(closed, simulate(hoap1(), sample(hoap1(), replay), options)), 4e-4);
}

/// A keyed jump of `height` [m], played with the robot's profile.
SimulationLog jump(const RobotModel& model, const Pattern& pattern, ControllerKind law,
                   const std::string& profile, const std::vector<Disturbance>& scenario) {
  SimulateOptions options;
  options.profile = profile;
  options.controller.type = law;
  options.scenario = scenario;
  options.settle = 2;
  return simulate(model, sample(model, pattern), options);
}

double largest_force(const SimulationLog& log) {
  double most = 0;
  for (const SimulationSample& s : log.samples) most = std::max(most, s.fz);
  return most;
}

// In the air, the law asks for no force. The robot lands no harder than without a law, on stiff
// servos and on soft ones.
TEST(DtadGaits, JumpsLandSoftly) {
  for (const double height : {0.01, 0.03}) {
    const Pattern pattern = jump_pattern(hoap1(), {.height = height});
    for (const char* profile : {"hoap1-strong", "hoap1-strong-soft"}) {
      SCOPED_TRACE(testing::Message() << height << " m, " << profile);
      const SimulationLog open = jump(hoap1(), pattern, ControllerKind::none, profile, {});
      const SimulationLog law = jump(hoap1(), pattern, ControllerKind::dtad, profile, {});
      EXPECT_EQ(law.result.outcome, Outcome::stands);
      EXPECT_LE(largest_force(law), largest_force(open));
      EXPECT_NEAR(law.result.apex, height, 0.002);
      for (const SimulationSample& s : law.samples) {
        if (s.command_fz == 0) {
          EXPECT_EQ(s.reference_fz, 0);
        }
      }
    }
  }
}

// The push turns the robot in the air and moves it away: the legs stay upright, and the law
// corrects the rest after the landing.
TEST(DtadGaits, APushInFlight) {
  const Pattern pattern = jump_pattern(hoap1(), {.height = 0.02, .times = 3});
  const double middle = 0.5 * (pattern.phases[0].until + pattern.phases[1].until);
  for (const double angle : {0.0, M_PI / 2, M_PI}) {
    SCOPED_TRACE(angle);
    const std::vector<Disturbance> pushed = {push(middle, angle, 2.2)};
    const auto outcome = [&](ControllerKind law) {
      return jump(hoap1(), pattern, law, "hoap1-strong", pushed).result.outcome;
    };
    EXPECT_EQ(outcome(ControllerKind::none), Outcome::fell);
    EXPECT_EQ(outcome(ControllerKind::dtad), Outcome::stands);
  }
}

// Motions that lean the trunk or lower the COG are pushed in the middle, near the capture bound: if
// the robot stands in open loop, it also stands with the law. A trunk that bows by 29 deg must not
// be turned so far that it counts as fallen.
TEST(DtadGaits, StandsWhereOpenLoopStands) {
  int stood = 0;
  for (const char* name : {"hoap1", "humanoid30"}) {
    const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/" + std::string(name));
    for (const auto& [kind, pattern] : {std::pair{"bow", bow_pattern(model, bow_defaults(model))},
                                        {"squat", squat_pattern(model, squat_defaults(model))},
                                        {"sit", sit_pattern(model, seat_defaults(model))}}) {
      const CommandSeries series = sample(model, pattern);
      const double middle = 0.5 * series.duration();
      const CaptureRegion region =
          capture_region(model, series, std::lround(middle / series.dt), 72);
      for (int i = 0; i < 4; ++i) {
        const double angle = i * M_PI / 2;
        const double bound = capture_bound(region, {std::cos(angle), std::sin(angle)});
        SCOPED_TRACE(testing::Message() << name << ", " << kind << ", " << angle);
        const auto outcome = [&](ControllerKind law) {
          SimulateOptions options;
          options.controller.type = law;
          options.scenario = {push(middle, angle, 0.95 * bound)};
          options.settle = 2;
          return simulate(model, series, options).result.outcome;
        };
        if (outcome(ControllerKind::none) != Outcome::stands) continue;
        ++stood;
        EXPECT_EQ(outcome(ControllerKind::dtad), Outcome::stands);
      }
    }
  }
  EXPECT_GE(stood, 12);
}

TEST(DtadGaits, TheLargeRobotWalksUnderItsPush) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/humanoid30");
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/humanoid30_walk.json");
  expect_stands(run(model, pattern, pattern.scenario, pattern.world), 0.003);
}

}  // namespace
}  // namespace ayumi
