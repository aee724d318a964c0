// Sensors whose readings are late. If the short-term loop is too fast, a robot that stands still
// oscillates between the edges of its soles after a small push.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

/// The robot stands on both feet for 3 s and is pushed to the left by 0.3 N s after 1 s. All sensor
/// readings are late by `latency` [s]. The robot can survive a push of more than ten times this
/// size.
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

/// Both feet stay loaded and hardly slip, and the measured ZMP stays near ref ZMP.
void expect_calm(const SimulationLog& log) {
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.zmp_tracking_rms, 0.008);
  EXPECT_LT(log.result.max_slip, 0.0001);
  EXPECT_EQ(log.result.steps, 0);
  for (const SimulationSample& s : log.samples)
    for (const Eigen::Vector3d& force : s.foot_force) ASSERT_GT(force.z(), 0);
}

// Without the gain damp, the distance of the measured ZMP from ref ZMP is 39 mm at 8 ms, and the
// ZMP does not come to rest.
TEST(SensorLatency, AStandingRobotStaysCalmUpToFourteenMilliseconds) {
  for (const double latency : {0.0, 0.004, 0.008, 0.010, 0.014}) {
    SCOPED_TRACE(latency);
    expect_calm(stands_pushed(hoap1(), latency));
  }
}

TEST(SensorLatency, TheGainsOfARobotWithoutGainsOfItsOwnDoAsWell) {
  RobotDescription description = hoap1().description();
  description.control.dtad.clear();
  const RobotModel model(description);
  for (const double latency : {0.004, 0.014}) {
    SCOPED_TRACE(latency);
    expect_calm(stands_pushed(model, latency));
  }
}

// Without the gain damp, the distance of the measured ZMP from ref ZMP is 34 mm at 10 ms.
TEST(SensorLatency, ViipStaysCalmUpToFourteenMilliseconds) {
  for (const double latency : {0.0, 0.004, 0.010, 0.014}) {
    SCOPED_TRACE(latency);
    expect_calm(stands_pushed(hoap1(), latency, "viip"));
  }
}

struct LateWalk {
  std::string pattern;
  double slope, sole;  // [rad], [N/m]; 0 for the values of the pattern and the robot
  double most;         // largest rms of measured ZMP - ref ZMP with sensors that are 14 ms late [m]
};

// The readings are 14 ms late: 10 ms for the sensors, and the rest for the lag of HOAP-1's servos.
// The rms of measured ZMP - ref ZMP is 8.9, 30.6, 19.7, 23.1 and 9.4 mm. Without the gain damp, the
// feet of HOAP-1 hammer in all cases.
TEST(SensorLatency, NoFootHammersWhileWalkingAndStepping) {
  for (const LateWalk& c :
       {LateWalk{"hoap1_walk", 0, 0, 0.011}, LateWalk{"hoap1_walk", -3 * M_PI / 180, 0, 0.036},
        LateWalk{"hoap1_walk", 0, 60000, 0.024}, LateWalk{"hoap1_viip_step", 0, 0, 0.028},
        LateWalk{"humanoid30_walk", 0, 0, 0.012}}) {
    SCOPED_TRACE(testing::Message() << c.pattern << " " << c.slope << " " << c.sole);
    const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/" + c.pattern + ".json");
    RobotDescription description =
        load_robot(AYUMI_SOURCE_DIR "/robots/" + pattern.robot).description();
    if (c.sole > 0)
      for (auto& [link, sole] : description.soles) sole.stiffness = c.sole;
    const RobotModel model(description);
    SimulateOptions options;
    options.controller = pattern.controller;
    options.profile = pattern.profile;
    options.world = pattern.world;
    options.world.slope.y() += c.slope;
    options.scenario = {{.duration = 100, .what = Latency{0.014}}};
    const SimulationResult r = simulate(model, sample(model, pattern), options).result;
    EXPECT_EQ(r.outcome, Outcome::stands);
    EXPECT_LT(r.zmp_amplitude, 0.002);
    EXPECT_LT(r.zmp_tracking_rms, c.most);
  }
}

}  // namespace
}  // namespace ayumi
