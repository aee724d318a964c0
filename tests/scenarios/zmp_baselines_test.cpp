// The baselines on the bundled walks of both robots: unpushed they stand at the end, and a push
// that fells open loop does not fell them.
#include <gtest/gtest.h>

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

INSTANTIATE_TEST_SUITE_P(Each, Baselines, testing::Values("preview", "foot-guided", "dcm-step"));

}  // namespace
}  // namespace ayumi
