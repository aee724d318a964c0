// The baselines on the bundled walks of both robots: without a push the robot stands at the end,
// and it does not fall after a push with which it falls in open loop.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/expect_stands.hpp"

namespace ayumi {
namespace {

struct BundledWalk {
  RobotModel model;
  Pattern pattern;
  CommandSeries series;
  explicit BundledWalk(const std::string& name)
      : model(load_robot(AYUMI_SOURCE_DIR "/robots/" + name)),
        pattern(read_pattern(AYUMI_SOURCE_DIR "/patterns/" + name + "_walk.json")),
        series(sample(model, pattern)) {}
};

SimulationResult run(const BundledWalk& walk, const std::string& controller, double impulse) {
  SimulateOptions options;
  options.controller.type = controller_type(controller);
  options.profile = walk.pattern.profile;
  options.world = walk.pattern.world;
  if (impulse != 0)
    options.scenario = {{.at = 0.5 * walk.series.duration(),
                         .duration = 0.02,
                         .what = Push{.magnitude = impulse, .direction = {1, 0, 0}}}};
  return simulate(walk.model, walk.series, options).result;
}

class Baselines : public testing::TestWithParam<const char*> {};

TEST_P(Baselines, StandAfterTheBundledWalks) {
  for (const auto& [robot, error] : {std::pair{"hoap1", 0.002}, std::pair{"humanoid30", 0.005}}) {
    SCOPED_TRACE(robot);
    const SimulationResult r = run(BundledWalk(robot), GetParam(), 0);
    test::expect_stands(r, error);
    EXPECT_EQ(r.steps, 9) << "each of the nine planned landings is one touchdown";
  }
}

TEST_P(Baselines, SurviveAPushThatFellsOpenLoop) {
  const BundledWalk walk("hoap1");
  EXPECT_EQ(run(walk, "none", 1.5).outcome, Outcome::fell);
  EXPECT_EQ(run(walk, GetParam(), 1.5).outcome, Outcome::stands);
}

// The push forward is 1.32 times the capture bound: the ratio q = 1 of the sidecar asks for the
// same ZMP as foot-guided control. With the 0.25 of HOAP-1 the robot falls.
TEST(DtadBesideBaselines, StandsThePushThatFootGuidedControlStands) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/humanoid30");
  const CommandSeries series = sample(model, stand_pattern(model, 2));
  const Push push = {.magnitude = 22.4, .direction = {1, 0, 0}};
  SimulateOptions options;
  options.scenario = {{.at = 0.5, .duration = 0.02, .what = push}};
  for (const char* law : {"dtad", "foot-guided"}) {
    options.controller.type = controller_type(law);
    EXPECT_EQ(simulate(model, series, options).result.outcome, Outcome::stands) << law;
  }
  options.controller = {ControllerKind::dtad, {{"q", 0.25}}};
  EXPECT_EQ(simulate(model, series, options).result.outcome, Outcome::fell);
}

INSTANTIATE_TEST_SUITE_P(Each, Baselines, testing::Values("preview", "foot-guided", "dcm-step"));

}  // namespace
}  // namespace ayumi
