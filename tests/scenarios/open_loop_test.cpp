// A walk is played without measurements: the servo targets compensate for lag and sag, so that an
// integrator that knows nothing of the plan moves as planned.
#include <gtest/gtest.h>

#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/hoap1_walk.hpp"

namespace ayumi {
namespace {

using test::hoap1;
using test::hoap1_walk;

SimulationLog played(const CommandSeries& series, const std::string& profile = "") {
  SimulateOptions options;
  options.profile = profile;
  options.controller.type = ControllerKind::none;
  return simulate(hoap1(), series, options);
}

/// The largest distance of the COG from its command [m].
double cog_off(const SimulationLog& log) {
  double most = 0;
  for (const SimulationSample& s : log.samples)
    most = std::max(most, (s.cog - s.command_cog).norm());
  return most;
}

TEST(OpenLoop, TheRobotMovesAsCommanded) {
  for (const bool soft : {false, true}) {
    SCOPED_TRACE(soft);
    const SimulationLog log = played(hoap1_walk(), soft ? "hoap1-soft" : "hoap1");
    ASSERT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_EQ(log.result.steps, 9);
    EXPECT_LT(cog_off(log), 0.001);
  }
}

// If the same angles are taken for values that servos received, they are sent as they are, and the
// robot gives way.
TEST(OpenLoop, SentAsTheyAreTheSameAnglesSag) {
  CommandSeries series = hoap1_walk();
  series.servo_commands = true;
  const SimulationLog log = played(series, "hoap1-soft");
  EXPECT_GT(log.result.steps, 10);
  EXPECT_GT(cog_off(log), 4 * cog_off(played(hoap1_walk(), "hoap1-soft")));
}

}  // namespace
}  // namespace ayumi
