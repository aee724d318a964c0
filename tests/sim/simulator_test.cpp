// A copy of a Simulator is a branch: same state, same future, its own scenario.
#include "ayumi/sim/simulator.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {
namespace {

constexpr long kAll = 1000000;

struct Stand {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  CommandSeries series = sample(model, stand_pattern(model, 0.6));
  SimulateOptions options;
  Stand() {
    options.controller.type = ControllerKind::dtad;
    options.sensor_noise = true;
    options.settle = 0.2;
    options.scenario = {push(0.3)};
  }
  static Disturbance push(double impulse, double at = 0.3) {
    return {.at = at, .duration = 0.02, .what = Push{.magnitude = impulse}};
  }
};

TEST(Simulator, WholeRunIsSimulate) {
  const Stand stand;
  Simulator simulator(stand.model, stand.series, stand.options);
  EXPECT_TRUE(simulator.advance(100));
  EXPECT_EQ(simulator.tick(), 100);
  EXPECT_FALSE(simulator.advance(kAll));
  const SimulationLog whole = simulate(stand.model, stand.series, stand.options);
  EXPECT_EQ(log_hash(simulator.take_log()), log_hash(whole));
}

TEST(Simulator, BranchGoesOnToTheSameBits) {
  const Stand stand;
  const std::string expected = log_hash(simulate(stand.model, stand.series, stand.options));
  // The trunk of the branches neither knows the push nor outlives them.
  SimulateOptions unpushed = stand.options;
  unpushed.scenario.clear();
  auto trunk = std::make_unique<Simulator>(stand.model, stand.series, unpushed);
  trunk->advance(250);
  Simulator branch = *trunk, other = *trunk;
  branch.set_scenario(stand.options.scenario);
  other.set_scenario({Stand::push(0.6)});
  trunk.reset();
  while (branch.advance(37)) other.advance(11);
  other.advance(kAll);
  EXPECT_EQ(log_hash(branch.take_log()), expected);
  EXPECT_NE(log_hash(other.take_log()), expected);
}

TEST(Simulator, WithoutSamplesTheVerdictIsTheSame) {
  const Stand stand;
  Simulator kept(stand.model, stand.series, stand.options);
  Simulator bare = kept;
  bare.keep_samples(false);
  kept.advance(kAll);
  bare.advance(kAll);
  const SimulationResult a = kept.result(), b = bare.result();
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.final_cog_error, b.final_cog_error);
  EXPECT_EQ(a.max_torque_ratio, b.max_torque_ratio);
  EXPECT_TRUE(bare.take_log().samples.empty());
  EXPECT_EQ(kept.take_log().samples.size(), 801u);
}

TEST(Simulator, RefusesAnUnknownLinkWhenTheScenarioIsReplaced) {
  const Stand stand;
  Simulator simulator(stand.model, stand.series, stand.options);
  try {
    simulator.set_scenario({{.what = Push{.magnitude = 1, .on = "trunkk"}}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no link 'trunkk'"), std::string::npos);
  }
}

}  // namespace
}  // namespace ayumi
