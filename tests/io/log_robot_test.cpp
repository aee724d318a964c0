// A log is only drawn and used in computations if it is a log of its robot.
#include "ayumi/io/run/log_robot.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

/// The robot stands for 1 s.
SimulationLog standing(const std::vector<Disturbance>& scenario = {}) {
  SimulateOptions options;
  options.scenario = scenario;
  options.settle = 0;
  return simulate(hoap1(), sample(hoap1(), stand_pattern(hoap1(), 1)), options);
}

Disturbance load(double at, double duration, double mass) {
  return {.at = at,
          .duration = duration,
          .what = Payload{.on = "r_forearm", .point = {0, 0, -0.05}, .mass = mass}};
}

std::string refused(const SimulationLog& log, const RobotModel& model = hoap1()) {
  return test::error_message([&] { require_robot_of(model, log, "run"); }, ErrorCode::bad_file);
}

TEST(LogRobot, FitsWithAndWithoutPayloads) {
  EXPECT_EQ(refused(standing()), "no error");
  for (const double at : {0.0, 0.2, 0.2004, 0.7})
    for (const double duration : {0.1, 0.1003, 5.0})
      EXPECT_EQ(refused(standing({load(at, duration, 0.2), load(0.4, 0.4, 0.1)})), "no error")
          << at << " " << duration;
}

TEST(LogRobot, PosturesOfAnotherRobotAreRefused) {
  const SimulationLog log = standing();
  const std::string differs = "' differs from the COG in the log by ";
  const auto changed = [&](const auto& change) {
    SimulationLog other = log;
    change(other.samples[300]);
    return refused(other);
  };
  const int a = hoap1().find_dof("l_knee"), b = hoap1().find_dof("r_hip_yaw");
  for (const std::string& message :
       {changed([&](SimulationSample& s) { std::swap(s.state.theta[a], s.state.theta[b]); }),
        changed([&](SimulationSample& s) { s.state.theta[a] += 1e-3; }),
        changed([&](SimulationSample& s) { s.state.theta[a] = 1e300; }),
        changed([](SimulationSample& s) { s.state.base.position.x() = 1e300; }),
        changed([](SimulationSample& s) { s.cog.x() += 1e-5; })}) {
    EXPECT_EQ(message.find("run: with the posture at 0.300 s, the COG of the robot '"), 0u)
        << message;
    EXPECT_NE(message.find(differs), std::string::npos) << message;
  }
  // The load is in the samples but not in the scenario, or the other way round.
  SimulationLog other = standing({load(0.2, 0.5, 0.2)});
  other.scenario.clear();
  EXPECT_NE(refused(other).find(differs), std::string::npos);
  other = log;
  other.scenario = {load(0.2, 0.5, 0.2)};
  EXPECT_NE(refused(other).find(differs), std::string::npos);
  std::get<Payload>(other.scenario[0].what).on = "tail";
  EXPECT_NE(refused(other).find("a payload on link 'tail', which the robot '"), std::string::npos);
}

TEST(LogRobot, OtherJointsAreRefused) {
  SimulationLog log = standing();
  std::swap(log.joints[0], log.joints[1]);
  EXPECT_EQ(refused(log).find("run: the run has the joints "), 0u);
  EXPECT_EQ(test::error_message([&] { require_postures_of(hoap1(), log, "run"); }).find("run: "),
            0u);
}

TEST(LogRobot, AttitudesAreRotations) {
  const SimulationLog log = standing();
  for (BasePose SimulationSample::*base :
       {&SimulationSample::reference_base, &SimulationSample::command_base})
    for (const double length : {0.0, 1.01, 1e200}) {
      SimulationLog other = log;
      (other.samples[7].*base).attitude.coeffs() *= length;
      EXPECT_EQ(refused(other).find("run: at t = 0.007 s the quaternion of an attitude"), 0u);
    }
  SimulationLog other = log;
  other.samples[7].state.base.attitude.coeffs().setZero();
  EXPECT_EQ(refused(other),
            "run: at t = 0.007 s the quaternion of an attitude has the length 0, but 1 is needed. "
            "The log has changed since the run; run the pattern again");
}

// The masses of this robot are in no file.
TEST(LogRobot, ADrawnRobotMayHaveOtherMasses) {
  SimulationLog log = standing();
  for (SimulationSample& sample : log.samples) sample.cog.x() += 0.01;
  log.events.insert(log.events.begin(), {0, EventKind::study_case, "case 3: mass of torso 1.1"});
  EXPECT_EQ(refused(log), "no error");
}

}  // namespace
}  // namespace ayumi
