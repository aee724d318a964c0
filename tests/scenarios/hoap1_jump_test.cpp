// The jumps of HOAP-1 under VIIP with the actuators of the paper's simulations, read from the log:
// their height, their landing, and the quantities that are conserved during the flight.
#include <gtest/gtest.h>

#include <regex>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/actuator_need.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/jump_figures.hpp"

namespace ayumi {
namespace {

using test::hoap1;

constexpr double kRef = 0.22;  // ref z_G of the patterns [m]

Pattern pattern_of(const std::string& name) {
  return read_pattern(AYUMI_SOURCE_DIR "/patterns/" + name + ".json");
}

SimulationLog run_jump(const Pattern& pattern, bool noise = false, int seed = 1) {
  SimulateOptions options;
  options.controller = pattern.controller;
  options.profile = pattern.profile;
  options.world = pattern.world;
  options.sensor_noise = noise;
  options.seed = static_cast<std::uint64_t>(seed);
  return simulate(hoap1(), sample(hoap1(), pattern), options);
}

Pattern with_goal(double height, double stoop, JumpGoal::Release release) {
  Pattern pattern = pattern_of("hoap1_jump");
  JumpGoal& goal = std::get<JumpGoal>(*pattern.phases[1].viip);
  goal.height = height;
  goal.stoop = stoop;
  goal.release = release;
  return pattern;
}

void expect_landing(const SimulationLog& log, double drift, const Eigen::Vector2d& way) {
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LE(test::feet_drift(hoap1(), log, way), drift);
}

// The expectations on each of these jumps, if it is released without angular momentum.
void expect_jump(const SimulationLog& log, double apex, double error, double stoop) {
  const auto jumps = test::jumps_of(hoap1(), log, kRef);
  ASSERT_EQ(jumps.size(), 1u);
  const test::JumpMeasured& j = jumps[0];
  EXPECT_NEAR(j.apex, apex, error * apex);
  EXPECT_NEAR(log.result.apex, j.apex, 1e-4);
  // Rebounds of the soles do not count; the force of a spring decreases through the 5 % at which
  // flight begins.
  EXPECT_NEAR(log.result.flight, j.touchdown - j.lift_off, 0.006);
  EXPECT_GT(j.clearance, 0.003);
  EXPECT_NEAR(j.stoop, stoop, 0.15 * stoop);
  EXPECT_LT(j.momentum, 1e-6);
  EXPECT_LT(test::settled_at(log, kRef, 0.003), j.lift_off + 0.7);
  expect_landing(log, 0.010, Eigen::Vector2d::Zero());
}

TEST(Hoap1Jump, RisesAsPlannedLandsAndSettles) {
  for (const double height : {0.02, 0.033, 0.05})
    for (const double stoop : {0.03, 0.035, 0.04}) {
      SCOPED_TRACE(testing::Message() << height << " " << stoop);
      expect_jump(run_jump(with_goal(height, stoop, JumpGoal::Release::ref_z)), height, 0.01,
                  stoop);
    }
}

// At the landing, the force is at most twice that of (27), which is m (speed^2 / z_d + g); no
// bounce lasts longer than 5 ms; and the spring is that of (27) for the real speed of the COG.
void expect_soft_landing(const SimulationLog& log, double stoop, double bounce) {
  const double mass = hoap1().mass(), weight = mass * 9.80665;
  const auto jumps = test::jumps_of(hoap1(), log, kRef);
  ASSERT_EQ(jumps.size(), 1u);
  const size_t down = static_cast<size_t>(std::lround(jumps[0].touchdown / log.dt));
  const double speed = -log.samples[down - 1].dcog.z();
  double peak = 0, air = 0, longest = 0, stiffness = 0;
  for (size_t k = down; k < log.samples.size(); ++k) {
    const SimulationSample& s = log.samples[k];
    peak = std::max(peak, s.fz);
    air = s.fz > 0 ? 0 : air + log.dt;
    longest = std::max(longest, air);
    if (s.law.stage == LawStage::landing) stiffness = s.law.K_Pz;
  }
  EXPECT_LE(peak, 2 * (mass * speed * speed / stoop + weight));
  EXPECT_LE(longest, bounce + 1e-9);
  EXPECT_NEAR(std::sqrt(stiffness / mass) * stoop, speed, 0.05 * speed);
}

TEST(Hoap1Jump, LegsYieldAtTheTouchdown) {
  using Release = JumpGoal::Release;
  for (const char* profile : {"hoap1-strong-soft", "hoap1-strong"})
    for (const Release release : {Release::ref_z, Release::spring})
      for (const double height : {0.02, 0.03, 0.04, 0.05})
        for (const double stoop : {0.03, 0.035, 0.04}) {
          if (release == Release::spring && height <= 0.5 * stoop) continue;
          // With stiff servos and the deepest stoop, the knees reach their stops, or are nearly
          // straight before the landing.
          if (std::string(profile) == "hoap1-strong" && stoop == 0.04) continue;
          SCOPED_TRACE(testing::Message() << profile << ", " << height << ", " << stoop
                                          << ", spring " << static_cast<int>(release));
          Pattern pattern = with_goal(height, stoop, release);
          pattern.profile = profile;
          expect_soft_landing(run_jump(pattern), stoop, 0.005);
        }
}

TEST(Hoap1Jump, LegsYieldWithNoiseOfTheSensors) {
  using Release = JumpGoal::Release;
  for (const auto& [release, height] : {std::pair{Release::ref_z, 0.02},
                                        {Release::ref_z, 0.03},
                                        {Release::ref_z, 0.045},
                                        {Release::spring, 0.02},
                                        {Release::spring, 0.045}})
    for (const int seed : {1, 2}) {
      SCOPED_TRACE(testing::Message()
                   << height << ", spring " << static_cast<int>(release) << ", seed " << seed);
      expect_soft_landing(run_jump(with_goal(height, 0.035, release), true, seed), 0.035, 0.020);
    }
}

TEST(Hoap1Jump, SpringHeldToItsEndRisesHigher) {
  for (const auto& [height, stoop] :
       {std::pair{0.024, 0.03}, {0.03, 0.04}, {0.04, 0.035}, {0.05, 0.03}, {0.05, 0.04}}) {
    SCOPED_TRACE(testing::Message() << height << " " << stoop);
    expect_jump(run_jump(with_goal(height, stoop, JumpGoal::Release::spring)),
                height + stoop * stoop / (4 * height), 0.05, stoop);
  }
}

TEST(Hoap1Jump, WithNoiseAndLatencyOfTheSensors) {
  for (const double height : {0.03, 0.05})
    expect_jump(run_jump(with_goal(height, 0.04, JumpGoal::Release::ref_z), true), height, 0.02,
                0.04);
}

TEST(Hoap1Jump, HopsThreeTimesInPlace) {
  const SimulationLog log = run_jump(pattern_of("hoap1_hop3"));
  const auto jumps = test::jumps_of(hoap1(), log, kRef);
  ASSERT_EQ(jumps.size(), 3u);
  for (const test::JumpMeasured& j : jumps) EXPECT_NEAR(j.apex, 0.03, 0.02 * 0.03);
  expect_landing(log, 0.020, Eigen::Vector2d::Zero());
}

TEST(Hoap1Jump, JumpsForward) {
  const SimulationLog log = run_jump(pattern_of("hoap1_jump_forward"));
  ASSERT_EQ(test::jumps_of(hoap1(), log, kRef).size(), 1u);
  expect_landing(log, 0.005, {0.02, 0});
}

TEST(Hoap1Jump, GeneratedKeysNeedTheStrongActuators) {
  const CommandSeries series = sample(hoap1(), jump_pattern(hoap1(), jump_defaults(hoap1())));
  CheckOptions options;
  options.profile = "hoap1-strong";
  const ConsistencyReport strong = check_consistency(hoap1(), series, options);
  EXPECT_EQ(actuator_need(hoap1(), series, options, strong).text, "");
  options.profile = "hoap1";
  const ConsistencyReport real = check_consistency(hoap1(), series, options);
  const ActuatorNeed need = actuator_need(hoap1(), series, options, real);
  for (const char* words : {"profile hoap1 is too weak: the motion needs ", " N m at ",
                            " deg/s at ", "hoap1-strong, hoap1-strong-soft are strong enough"})
    EXPECT_NE(need.text.find(words), std::string::npos) << need.text;
  EXPECT_EQ(need.sufficient, (std::vector<std::string>{"hoap1-strong", "hoap1-strong-soft"}));
  EXPECT_TRUE(std::regex_search(
      need.flight, std::regex("knee allows a flight of at most 0.0[0-9]+ s \\(a rise of [0-9.]+ "
                              "mm\\), because .*The planned flight lasts ")))
      << need.flight;
}

TEST(Hoap1Jump, AGoalIsJudgedByItsKeyedJump) {
  const Pattern pattern = pattern_of("hoap1_jump");
  const CommandSeries series = sample(hoap1(), pattern);
  const std::vector<KeyedGoal> goals = keyed_goals(hoap1(), series, pattern.controller);
  CheckOptions options;
  options.profile = "hoap1-strong";
  EXPECT_EQ(actuator_need(hoap1(), goals, options).text, "");
  options.profile = "hoap1";
  const ActuatorNeed need = actuator_need(hoap1(), goals, options);
  EXPECT_NE(need.text.find("VIIP jump at 0.50 s: profile hoap1 is too weak"), std::string::npos)
      << need.text;
}

}  // namespace
}  // namespace ayumi
