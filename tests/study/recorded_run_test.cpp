// The set around the run without a push: a robot whose state is in the set stands at the end.
#include "ayumi/study/recorded_run.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {
namespace {

constexpr double kPushTime = 1.6;  // time of the push [s]

/// A short walk under a law, recorded at every tick, and a copy just before the push.
struct RecordedWalk {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  CommandSeries series = sample(model, walk_pattern(model, {.steps = 4}));
  SimulateOptions options;
  std::optional<Simulator> before;
  std::optional<RecordedRun> unpushed;

  explicit RecordedWalk(ControllerKind law, const World& world = {}) {
    options.controller = {law, {}};
    options.world = world;
    Simulator run(model, series, options);
    unpushed.emplace(world);
    while (run.advance(1)) {
      unpushed->record(run);
      if (run.tick() == std::lround(kPushTime / series.dt) - 1) before = run;
    }
    EXPECT_EQ(run.result().outcome, Outcome::stands);
  }

  /// A copy of the run with a push along +y, whose level is in capture bounds.
  Simulator pushed(double level) const {
    const long k = std::lround(kPushTime / series.dt);
    const double bound = capture_bound(capture_region(model, series, k), {0, 1});
    Simulator run = *before;
    run.set_scenario({{.at = kPushTime,
                       .duration = 0.02,
                       .what = Push{.magnitude = level * bound, .direction = {0, 1, 0}}}});
    return run;
  }

  /// The first time after the push at which the run is in the set; nothing if that never happens.
  std::optional<double> returns(Simulator& run) const {
    while (run.advance(1) && !run.fell())
      if (run.time() > kPushTime + 0.02 && unpushed->contains(run)) return run.time();
    return std::nullopt;
  }
};

TEST(RecordedRun, ContainsItself) {
  const RecordedWalk walk(ControllerKind::dtad);
  Simulator run = *walk.before;
  run.advance(1);
  EXPECT_EQ(walk.unpushed->deviation(run), 0);
  EXPECT_TRUE(walk.unpushed->contains(run));
}

TEST(RecordedRun, ContainsARunThatHasRecoveredAndThenStands) {
  for (const ControllerKind law : {ControllerKind::dtad, ControllerKind::none}) {
    const RecordedWalk walk(law);
    Simulator run = walk.pushed(law == ControllerKind::none ? 0.1 : 0.6);
    run.advance(22);
    EXPECT_GT(walk.unpushed->deviation(run), 1);
    EXPECT_FALSE(walk.unpushed->contains(run));
    const std::optional<double> at = walk.returns(run);
    ASSERT_TRUE(at);
    EXPECT_LT(*at, kPushTime + 1.0);
    while (run.advance(100)) {
    }
    EXPECT_EQ(run.result().outcome, Outcome::stands);
  }
}

TEST(RecordedRun, NeverContainsARunThatFalls) {
  const RecordedWalk walk(ControllerKind::dtad);
  Simulator run = walk.pushed(3);
  EXPECT_FALSE(walk.returns(run));
  EXPECT_TRUE(run.fell());
}

TEST(RecordedRun, DecidesNothingAtTheEnd) {
  const RecordedWalk walk(ControllerKind::dtad);
  Simulator run = *walk.before;
  while (run.time() < walk.series.duration() + walk.options.settle - 0.9) run.advance(1);
  EXPECT_EQ(walk.unpushed->deviation(run), 0);
  EXPECT_FALSE(walk.unpushed->contains(run));
}

TEST(RecordedRun, OnUnevenGroundContainsOnlyWhatIsInTheSamePlace) {
  // The block is far from the walk. The runs are the same, but in a world with a block, a state is
  // only in the set if the robot is in the same place.
  World world;
  world.blocks = {{.low = {5, 5}, .high = {6, 6}, .height = 0.1}};
  const RecordedWalk level(ControllerKind::dtad), uneven(ControllerKind::dtad, world);
  Simulator on_level = level.pushed(0.9), on_uneven = uneven.pushed(0.9);
  ASSERT_TRUE(level.returns(on_level));
  while (on_uneven.tick() < on_level.tick()) on_uneven.advance(1);
  EXPECT_GE(uneven.unpushed->deviation(on_uneven), level.unpushed->deviation(on_level));
}

}  // namespace
}  // namespace ayumi
