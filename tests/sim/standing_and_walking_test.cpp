// HOAP-1 in the closed loop: stillness at rest for every servo gain, the effect of half the
// integrator's step, and a world at another place.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/mirror.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using test::hoap1;

RobotModel with_gain(double kp) {
  RobotDescription d = hoap1().description();
  for (auto& [name, servo] : d.servos) {
    servo.kd *= kp / servo.kp;
    servo.kp = kp;
  }
  return RobotModel(d);
}

const CommandSeries& walk() {
  static const CommandSeries series =
      sample(hoap1(), read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
  return series;
}

/// The walk turns left and steps aside to the right, so that it is not like its own mirror image.
const CommandSeries& curve() {
  static const CommandSeries series = [] {
    WalkParameters parameters = walk_defaults(hoap1());
    parameters.steps = 4;
    parameters.turn = 0.12;
    parameters.side = -0.015;
    parameters.first_swing = Side::left;
    return sample(hoap1(), walk_pattern(hoap1(), parameters));
  }();
  return series;
}

SimulationLog run(const RobotModel& model, const CommandSeries& series,
                  const std::string& controller, int substeps = 1, double settle = 1.0) {
  SimulateOptions options;
  options.controller.type = controller_type(controller);
  options.substeps = substeps;
  options.settle = settle;
  return simulate(model, series, options);
}

class Standing : public testing::TestWithParam<std::tuple<double, std::string>> {};

TEST_P(Standing, IsStillAfterOneSecond) {
  const auto& [kp, controller] = GetParam();
  const RobotModel model = with_gain(kp);
  const SimulationLog log = run(model, test::standing(model, 3.0), controller);
  ASSERT_EQ(log.result.outcome, Outcome::stands);
  Vector3d low = log.samples[1000].zmp, high = low;
  double least = log.samples[1000].fz, most = least;
  for (size_t k = 1000; k < log.samples.size(); ++k) {
    low = low.cwiseMin(log.samples[k].zmp);
    high = high.cwiseMax(log.samples[k].zmp);
    least = std::min(least, log.samples[k].fz);
    most = std::max(most, log.samples[k].fz);
  }
  EXPECT_LT((high - low).norm(), 5e-5);
  EXPECT_LT(most - least, 0.05);
  EXPECT_NEAR(most, model.mass() * kGravity, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Gains, Standing,
                         testing::Combine(testing::Values(200.0, 300.0, 450.0, 600.0, 900.0),
                                          testing::Values("none", "dtad")));

double largest_difference(const SimulationLog& a, const SimulationLog& b) {
  double largest = 0;
  for (size_t k = 0; k < a.samples.size(); ++k)
    largest = std::max(largest, (a.samples[k].cog - b.samples[k].cog).norm());
  return largest;
}

class Walking : public testing::TestWithParam<std::string> {};

TEST_P(Walking, HardlyChangesWithHalfTheStep) {
  for (const CommandSeries* plan : {&walk(), &curve()}) {
    const SimulationLog whole = run(hoap1(), *plan, GetParam());
    const SimulationLog half = run(hoap1(), *plan, GetParam(), 2);
    ASSERT_EQ(whole.result.outcome, Outcome::stands);
    ASSERT_EQ(whole.samples.size(), half.samples.size());
    EXPECT_LT(largest_difference(whole, half), 2e-3);
  }
}

/// The plan as seen from another place: turned by `yaw`, then moved.
CommandSeries moved(CommandSeries series, double yaw, const Vector3d& offset) {
  const Eigen::Quaterniond R = exp_rotation({0, 0, yaw});
  const auto place = [&](Vector3d& p) { p = (R * p + offset).eval(); };
  const auto turn = [&](Vector3d& v) { v = (R * v).eval(); };
  for (CommandSample& s : series.samples) {
    place(s.state.base.position);
    s.state.base.attitude = R * s.state.base.attitude;
    turn(s.state.base_velocity);
    turn(s.state.base_angular_velocity);
    s.acceleration.head<3>() = (R * s.acceleration.head<3>()).eval();
    s.acceleration.segment<3>(3) = (R * s.acceleration.segment<3>(3)).eval();
    place(s.cog);
    place(s.zmp);
    turn(s.dcog);
    turn(s.ddcog);
    for (Eigen::Isometry3d& foot : s.feet) foot = Eigen::Translation3d(offset) * R * foot;
  }
  return series;
}

TEST_P(Walking, IsTheSameElsewhere) {
  const double yaw = 2.1;
  const Vector3d offset(1000, -300, 0);
  for (const CommandSeries* plan : {&walk(), &curve()}) {
    const SimulationLog here = run(hoap1(), *plan, GetParam());
    SimulationLog there = run(hoap1(), moved(*plan, yaw, offset), GetParam());
    ASSERT_EQ(here.samples.size(), there.samples.size());
    for (SimulationSample& s : there.samples)
      s.cog = exp_rotation({0, 0, -yaw}) * Vector3d(s.cog - offset);
    EXPECT_LT(largest_difference(here, there), 1e-6);
  }
}

// The mirror images of robot, plan and world give the mirror image of the walk, with and without a
// push: nothing in dynamics, contact or control depends on left and right, or on the order of the
// contacts.
TEST_P(Walking, IsTheSameInAMirror) {
  const RobotModel image(test::mirrored(hoap1().description()));
  const std::pair<const CommandSeries*, double> cases[] = {
      {&walk(), 0.0}, {&walk(), 0.5}, {&curve(), 0.0}};
  for (const auto& [walk, push] : cases) {
    SimulateOptions options;
    options.controller.type = controller_type(GetParam());
    const auto pushed = [&](const Vector3d& direction) -> std::vector<Disturbance> {
      if (push == 0) return {};
      return {
          {.at = 1.9, .duration = 0.02, .what = Push{.magnitude = push, .direction = direction}}};
    };
    const Vector3d direction(0.6, 0.8, 0);
    options.scenario = pushed(direction);
    const SimulationLog here = simulate(hoap1(), *walk, options);
    options.scenario = pushed(test::mirrored(direction));
    const CommandSeries plan = test::mirrored(hoap1(), image, *walk);
    SimulationLog there = simulate(image, plan, options);
    ASSERT_EQ(there.result.outcome, here.result.outcome);
    ASSERT_EQ(here.samples.size(), there.samples.size());
    for (SimulationSample& s : there.samples) s.cog = test::mirrored(s.cog);
    EXPECT_LT(largest_difference(here, there), 1e-6) << push << " N s";
  }
}

INSTANTIATE_TEST_SUITE_P(Controllers, Walking, testing::Values("none", "dtad"));

}  // namespace
}  // namespace ayumi
