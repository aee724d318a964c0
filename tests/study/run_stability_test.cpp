// The stability strip of a run agrees with results that are computed in another way.
#include "ayumi/task/run_stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {
namespace {

const RobotModel& hoap() {
  static const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  return model;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    if (!std::isnan(value)) most = std::max(most, value);
  return most;
}

double least(const std::vector<double>& values) {
  double most = std::numeric_limits<double>::infinity();
  for (const double value : values)
    if (!std::isnan(value)) most = std::min(most, value);
  return most;
}

SimulationLog run_of(const CommandSeries& series, double impulse) {
  SimulateOptions options;
  options.controller = {ControllerKind::dtad, {}};
  if (impulse > 0) {
    Push push;
    push.kind = PushKind::impulse;
    push.magnitude = impulse;
    push.direction = {0, -1, 0};
    options.scenario = {{.at = 0.8, .duration = 0.02, .what = push}};
  }
  return simulate(hoap(), series, options);
}

TEST(RunStability, SharesAreThoseOfTheResult) {
  const CommandSeries series = sample(hoap(), walk_pattern(hoap(), {.steps = 2}));
  const SimulationLog log = run_of(series, 0);
  const StabilitySeries strip = run_stability(hoap(), hoap().limits(""), log);
  EXPECT_NEAR(largest(strip.speed), log.result.speed.ratio, 1e-9);
  EXPECT_NEAR(largest(strip.torque), log.result.torque.ratio, 1e-9);
  EXPECT_NEAR(strip.dt * static_cast<double>(strip.speed.size()),
              log.dt * static_cast<double>(log.samples.size()), strip.dt);
}

// The plan and the run of a robot that stands are nearly the same motion, and so are their strips.
TEST(RunStability, OfARobotThatStandsItIsThatOfThePlan) {
  Pattern pattern;
  pattern.phases = {{.until = 2, .support = Support::both, .swing = {}}};
  const CommandSeries series = sample(hoap(), pattern);
  const SimulationLog log = run_of(series, 0);
  const StabilitySeries run = run_stability(hoap(), hoap().limits(""), log);
  const StabilitySeries plan = stability_series(hoap(), series, {});
  for (size_t i = 100; i < plan.zmp_margin.size() - 1; ++i) {
    EXPECT_NEAR(run.zmp_margin[i], plan.zmp_margin[i], 3e-3) << i;
    EXPECT_NEAR(run.dcm_margin[i], plan.dcm_margin[i], 3e-3) << i;
    EXPECT_NEAR(run.normal_force[i], hoap().mass() * kGravity, 1) << i;
  }
}

// A push drives the ZMP to the edge of the soles, which the plan does not contain.
TEST(RunStability, APushLeavesItsTrace) {
  Pattern pattern;
  pattern.phases = {{.until = 2, .support = Support::both, .swing = {}}};
  const CommandSeries series = sample(hoap(), pattern);
  const double before =
      least(run_stability(hoap(), hoap().limits(""), run_of(series, 0)).zmp_margin);
  const StabilitySeries strip = run_stability(hoap(), hoap().limits(""), run_of(series, 2));
  EXPECT_LT(least(strip.zmp_margin), 0.5 * before);
  const auto at = std::min_element(strip.zmp_margin.begin(), strip.zmp_margin.end(),
                                   [](double a, double b) { return std::isnan(b) || a < b; });
  EXPECT_GE(strip.dt * static_cast<double>(at - strip.zmp_margin.begin()), 0.79);
}

}  // namespace
}  // namespace ayumi
