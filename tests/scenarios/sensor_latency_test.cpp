// Sensors whose readings are late. A short-term loop that is closed too fast makes a robot that
// stands still oscillate from edge to edge of its soles after a small push.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

/// The robot stands on both feet for 3 s with sensors that are late [s] and is pushed to the left
/// by 0.3 N s after 1 s. It survives more than ten times as much.
SimulationLog stands_pushed(const RobotModel& model, double latency,
                            const std::string& controller = "dtad") {
  Pattern pattern = stand_pattern(model, 3.0);
  if (controller == "viip") {
    pattern.keyframes.clear();
    pattern.phases = {{3.0, Support::both, {}, CogGoal{}}};
  }
  SimulateOptions options;
  options.controller.type = controller_type(controller);
  options.scenario = {
      {.at = 1.0, .duration = 0.02, .what = Push{.magnitude = 0.3, .direction = {0, 1, 0}}},
      {.duration = 100, .what = Latency{latency}}};
  return simulate(model, sample(model, pattern), options);
}

/// Both feet stay loaded, hardly slip, and the measured ZMP stays near ref ZMP.
void expect_calm(const SimulationLog& log) {
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.zmp_tracking_rms, 0.008);
  EXPECT_LT(log.result.max_slip, 0.0001);
  EXPECT_EQ(log.result.steps, 0);
  for (const SimulationSample& s : log.samples)
    for (const Eigen::Vector3d& force : s.foot_force) ASSERT_GT(force.z(), 0);
}

// With ka 2.5 and ks = kd = 2 the distance was 50 mm at 4 ms, and the feet slipped by 14 mm.
TEST(SensorLatency, AStandingRobotStaysCalmUpToEightMilliseconds) {
  for (const double latency : {0.0, 0.004, 0.008}) {
    SCOPED_TRACE(latency);
    expect_calm(stands_pushed(hoap1(), latency));
  }
}

TEST(SensorLatency, TheGainsOfARobotWithoutGainsOfItsOwnDoAsWell) {
  RobotDescription description = hoap1().description();
  description.control.dtad.clear();
  const RobotModel model(description);
  for (const double latency : {0.004, 0.008}) {
    SCOPED_TRACE(latency);
    expect_calm(stands_pushed(model, latency));
  }
}

// The filter of the measured ZMP is short enough: with tau_z 0.066 the distance was 6.6 mm.
TEST(SensorLatency, ViipStaysCalmAtFourMilliseconds) {
  for (const double latency : {0.0, 0.004}) {
    SCOPED_TRACE(latency);
    const SimulationLog log = stands_pushed(hoap1(), latency, "viip");
    expect_calm(log);
    EXPECT_LT(log.result.zmp_tracking_rms, 0.005);
  }
}

}  // namespace
}  // namespace ayumi
