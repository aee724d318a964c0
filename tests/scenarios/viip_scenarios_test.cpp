// VIIP on HOAP-1 in Ayumi's integrator: results on which a user relies, in metres, seconds and
// newton seconds.
#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/study/push.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using test::hoap1;

struct Goal {
  double until;
  ViipGoal goal;
};

// A pattern of these goals with legs bent enough for long steps, unless another height is given.
Pattern goals(const std::vector<Goal>& list, double height = 0.225) {
  Pattern pattern;
  pattern.robot = "hoap1";
  pattern.cog_height = height;
  for (const Goal& each : list)
    pattern.phases.push_back({each.until, Support::both, {}, each.goal});
  return pattern;
}

struct Conditions {
  std::string profile = "hoap1-strong", controller = "viip";
  bool noise = false;
  std::vector<Disturbance> pushes = {};
  std::vector<std::pair<std::string, double>> gains = {};
};

SimulationLog run_viip(const Pattern& pattern, const Conditions& conditions = {}) {
  SimulateOptions options;
  options.controller.type = controller_type(conditions.controller);
  options.controller.gains = conditions.gains;
  options.profile = conditions.profile;
  options.sensor_noise = conditions.noise;
  options.scenario = conditions.pushes;
  return simulate(hoap1(), sample(hoap1(), pattern), options);
}

StepGoal walk(int steps, double velocity, double turn = 0) {
  StepGoal goal;
  goal.steps = steps;
  goal.velocity.x() = velocity;
  goal.turn = turn;
  return goal;
}

Disturbance push(double at, const Vector3d& direction, double impulse) {
  return {.at = at,
          .duration = 0.02,
          .what = Push{.magnitude = impulse, .direction = direction.normalized()}};
}

TEST(ViipHoap1, CogGoesToADisplacementOnBothFeet) {
  for (const Vector3d& way : {Vector3d(0.02, 0, 0), Vector3d(0.04, 0, 0), Vector3d(0, 0.05, 0),
                              Vector3d(0, 0, -0.015), Vector3d(0.025, 0.025, -0.015)}) {
    SCOPED_TRACE(way.transpose());
    const SimulationLog log = run_viip(goals({{0.5, CogGoal{}}, {3.5, CogGoal{way}}}, 0));
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    const Vector3d from = log.samples[499].cog;
    double settled = 0, squares = 0;
    for (size_t k = 500; k < 3500; ++k) {
      const SimulationSample& s = log.samples[k];
      if ((s.cog - from - way).norm() > 0.002) settled = 1e-3 * static_cast<double>(k - 499);
      squares += (s.measured_zmp - s.reference_zmp).head<2>().squaredNorm();
    }
    EXPECT_LE(settled, 1.1);
    EXPECT_LE(std::sqrt(squares / 3000), 0.0015);
    // The height does not overshoot: (25) with the mass holds.
    for (const SimulationSample& s : log.samples)
      EXPECT_GE(s.reference_cog.z() - from.z(), way.z() - 0.0003);
  }
}

// The COG moves at the goal's velocity, ref v_G, and stops where the phase ends. This also holds
// after a push on the way, and with noisy and late sensors.
TEST(ViipHoap1, CogMovesAtACommandedVelocityOnBothFeet) {
  const double from = 0.5, moving = 1.2, push_at = 0.9;
  for (const Vector3d& velocity : {Vector3d(0.03, 0, 0), Vector3d(-0.02, 0.025, 0),
                                   Vector3d(0, 0, -0.03), Vector3d(0.01, -0.02, -0.01)})
    for (const bool hard : {false, true}) {
      SCOPED_TRACE(testing::Message() << velocity.transpose() << (hard ? ", pushed" : ""));
      Conditions c{.profile = "hoap1", .noise = hard};
      if (hard) c.pushes = {push(push_at, {0, 1, 0}, 0.3)};
      const SimulationLog log = run_viip(goals({{from, CogGoal{}},
                                                {from + moving, CogVelocityGoal{velocity}},
                                                {from + moving + 1.5, CogVelocityGoal{}}},
                                               0),
                                         c);
      EXPECT_EQ(log.result.outcome, Outcome::stands);
      const Vector3d start = log.samples[499].cog;
      EXPECT_LT((log.samples.back().cog - start - moving * velocity).norm(), hard ? 4e-3 : 1e-3);
      // The mean velocity over the last quarter of the motion, when the effect of a push is over.
      // The COG is then up to 1.3 mm/s faster, because it compensates for its late start.
      const Vector3d mean = (log.samples[1690].cog - log.samples[1390].cog) / 0.3;
      EXPECT_LT((mean - velocity).norm(), hard ? 8e-3 : 2e-3) << mean.transpose();
      for (const SimulationSample& s : log.samples) EXPECT_GT(s.fz, 30.0);
    }
}

// A force F from above sinks the standing robot by F / K_Pz, (24), on stiff servos and on soft
// ones, with sensors up to 10 ms late.
TEST(ViipHoap1, YieldsToAVerticalForceAsKpzSays) {
  const double force = 3, weight = hoap1().mass() * 9.80665;
  const Pattern pattern = goals({{4, CogGoal{}}});
  for (const char* profile : {"hoap1", "hoap1-soft"})
    for (const double kz : {1.5, 3.0, 6.0})
      for (const double latency : {0.0, 0.01}) {
        SCOPED_TRACE(testing::Message() << profile << ", kz " << kz << ", late by " << latency);
        Conditions c{.profile = profile, .gains = {{"kz", kz}}};
        c.pushes = {
            {.at = 0.5,
             .duration = 10,
             .what = Push{.kind = PushKind::force, .magnitude = force, .direction = {0, 0, -1}}},
            {.at = 0, .duration = 10, .what = Latency{latency}}};
        const SimulationLog log = run_viip(pattern, c);
        const double z = log.samples[400].cog.z(), omega2 = 9.80665 / z;
        const double expected = force / (weight / 9.80665 * kz * kz * omega2);
        const double sunk = z - log.samples[3900].cog.z();
        EXPECT_EQ(log.result.outcome, Outcome::stands);
        EXPECT_NEAR(sunk, expected, 0.1 * expected);
      }
}

// An impulse J from above sinks the standing robot by J / (e m kz omega): the spring of (24) with
// critical damping.
TEST(ViipHoap1, YieldsToAnImpulseFromAboveAsKpzSays) {
  const Pattern pattern = goals({{3, CogGoal{}}});
  for (const double kz : {0.5, 1.5, 3.0})
    for (const double impulse : {0.3, 1.5}) {
      if (kz < 1 && impulse > 1) continue;  // this would be deeper than the legs allow
      SCOPED_TRACE(testing::Message() << "kz " << kz << ", " << impulse << " N s");
      Conditions c{.profile = "hoap1-strong", .gains = {{"kz", kz}}};
      c.pushes = {push(0.5, {0, 0, -1}, impulse)};
      const SimulationLog log = run_viip(pattern, c);
      const double z = log.samples[490].cog.z(), omega = std::sqrt(9.80665 / z);
      double sunk = 0;
      for (const SimulationSample& s : log.samples) sunk = std::max(sunk, z - s.cog.z());
      const double expected = impulse / (M_E * hoap1().mass() * kz * omega);
      EXPECT_NEAR(sunk, expected, 0.1 * expected);
      EXPECT_EQ(log.result.outcome, Outcome::stands);
    }
}

// K_Pz and K_Dz of (24) change with the feet that carry load.
TEST(ViipHoap1, TheSpringChangesWithTheContact) {
  const double omega2 = 9.80665 / 0.225, weight = hoap1().mass() * 9.80665;
  const SimulationLog log = run_viip(goals({{0.5, CogGoal{}}, {4.5, walk(6, 0.05)}}),
                                     {.gains = {{"kz", 2}, {"kz_one", 1.2}}});
  int one = 0, both = 0;
  for (size_t k = 2; k < log.samples.size(); ++k) {
    // The law acts on a load that is one or two ticks old.
    double least = 1, most = 0;
    for (const size_t i : {k - 2, k - 1, k}) {
      const auto& feet = log.samples[i].foot_force;
      const double load = std::min(feet[0].z(), feet[1].z()) / weight;
      least = std::min(least, load);
      most = std::max(most, load);
    }
    const double kz = log.samples[k].law.K_Pz / (hoap1().mass() * omega2);
    if (least > 0.15) {
      ++both;
      EXPECT_NEAR(kz, 4, 0.05) << k;
    } else if (most < 0.05) {
      ++one;
      EXPECT_NEAR(kz, 1.44, 0.02) << k;
    }
    EXPECT_NEAR(log.samples[k].law.K_Dz, 2 * hoap1().mass() * std::sqrt(kz * omega2), 1) << k;
  }
  EXPECT_GT(one, 800);
  EXPECT_GT(both, 800);
}

// The ZMP follows the one that the law asks for, in the bundled patterns without their pushes. With
// noise, the figures are means over several seeds.
TEST(Viip, TheZmpFollows) {
  struct Case {
    const char* pattern;
    double error, noisy;  // largest error without and with noise [m]
  };
  for (const Case& c : {Case{"hoap1_viip_step", 0.005, 0.010},
                        {"hoap1_viip_walk", 0.006, 0.010},
                        {"humanoid30_viip_step", 0.012, 0.025},
                        {"humanoid30_viip_walk", 0.015, 0.025}}) {
    SCOPED_TRACE(c.pattern);
    const Pattern pattern =
        read_pattern(AYUMI_SOURCE_DIR "/patterns/" + std::string(c.pattern) + ".json");
    const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/" + pattern.robot);
    SimulateOptions options;
    options.controller = pattern.controller;
    options.profile = pattern.profile;
    const CommandSeries series = sample(model, pattern);
    const SimulationResult clean = simulate(model, series, options).result;
    EXPECT_EQ(clean.outcome, Outcome::stands);
    EXPECT_LE(clean.zmp_tracking_rms, c.error);
    options.sensor_noise = true;
    double mean = 0;
    for (const int seed : {1, 2, 3, 4}) {
      options.seed = static_cast<std::uint64_t>(seed);
      const SimulationResult noisy = simulate(model, series, options).result;
      EXPECT_EQ(noisy.outcome, Outcome::stands);
      mean += 0.25 * noisy.zmp_tracking_rms;
    }
    EXPECT_LE(mean, c.noisy);
  }
}

TEST(ViipHoap1, StepsInPlaceAndStandsWhereItStood) {
  const SimulationLog log = run_viip(goals({{0.3, CogGoal{}}, {5.8, walk(8, 0)}}));
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_EQ(log.result.steps, 8);
  EXPECT_LE(log.result.final_cog_error, 0.002);
  EXPECT_LE((log.samples.back().cog - log.samples.front().cog).norm(), 0.015);
}

TEST(ViipHoap1, WalksAtTheCommandedVelocity) {
  for (const double velocity : {0.05, 0.15, 0.25}) {
    SCOPED_TRACE(velocity);
    const SimulationLog log = run_viip(goals({{0.3, CogGoal{}}, {8.6, walk(14, velocity)}}));
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    // There are thirteen steps of v T, with T = 2.1 / omega.
    const double way = 13 * velocity * 2.1 / std::sqrt(9.80665 / log.samples[0].cog.z());
    EXPECT_NEAR(log.samples.back().cog.x() - log.samples.front().cog.x(), way, 0.02 * way);
    EXPECT_NEAR(log.samples.back().cog.y(), 0, 0.012);
    EXPECT_LE(log.result.final_cog_error, 0.002);
  }
}

TEST(ViipHoap1, RealActuatorsStandStepAndWalkToATenthOfAMetrePerSecond) {
  Conditions real;
  real.profile = "hoap1";
  for (const ViipGoal& goal :
       {ViipGoal(CogGoal{{0.02, 0, 0}}), ViipGoal(walk(8, 0)), ViipGoal(walk(2, 0.1)),
        ViipGoal(walk(14, 0.05)), ViipGoal(walk(14, 0.10))})
    EXPECT_EQ(run_viip(goals({{0.3, CogGoal{}}, {8.6, goal}}), real).result.outcome,
              Outcome::stands);
}

TEST(ViipHoap1, StepsWithNoisyLateSensors) {
  Conditions noisy;
  noisy.noise = true;
  for (const double velocity : {0.0, 0.1})
    EXPECT_EQ(run_viip(goals({{0.3, CogGoal{}}, {8.6, walk(14, velocity)}}), noisy).result.outcome,
              Outcome::stands);
}

// m omega times the distance to the toes is 2.1 N s: only a step forward can stop the robot here.
TEST(ViipHoap1, APushWhileSteppingMovesTheFeet) {
  const Pattern steps = goals({{0.3, CogGoal{}}, {7.0, walk(10, 0)}});
  Conditions pushed;
  pushed.pushes = {push(2.5, {1, 0, 0}, 3.4)};
  const SimulationLog log = run_viip(steps, pushed);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  double ahead = 0;
  for (const SimulationSample& s : log.samples) ahead = std::max(ahead, s.reference_zmp.x());
  EXPECT_GT(ahead, 0.07);  // the sole on which it stood ends at 0.056
}

// The robot is pushed forward in the middle of a double support by 2.2 times m omega d_edge.
TEST(ViipHoap1, AStepThatComesSoonerStopsALargerPush) {
  const Pattern steps = goals({{0.5, CogGoal{}}, {5.5, walk(12, 0)}});
  Conditions pushed;
  pushed.pushes = {push(2.572, {1, 0, 0}, 2.2 * 2.103)};
  EXPECT_EQ(run_viip(steps, pushed).result.outcome, Outcome::stands);
  pushed.gains = {{"hurry", 100}};
  EXPECT_EQ(run_viip(steps, pushed).result.outcome, Outcome::fell);
}

TEST(ViipHoap1, WithNothingMeasuredItFallsWhereNoticedLandingsAreEnough) {
  // The legs are as at home, and the robot turns by 10 deg a second.
  const Pattern pattern = goals({{0.5, CogGoal{}}, {6.5, walk(14, 0.2, 0.1745)}}, 0);
  Conditions conditions;
  conditions.controller = "viip-landings";
  EXPECT_EQ(run_viip(pattern, conditions).result.outcome, Outcome::stands);
  conditions.controller = "viip-nofeedback";
  EXPECT_EQ(run_viip(pattern, conditions).result.outcome, Outcome::fell);
}

// The hardest case: the weight is moving to the left foot, and the push is to its outer side, where
// no foot can follow without crossing. The nominal ZMP inside the sole leaves the room for it.
TEST(ViipHoap1, APushToTheOuterSideOfTheNextStanceFootIsTakenByTheSole) {
  const Pattern steps = goals({{0.5, CogGoal{}}, {5.5, walk(12, 0)}});
  SimulateOptions options;
  options.profile = "hoap1-strong";
  const std::vector<PushPhase> phases =
      default_push_phases(hoap1(), sample(hoap1(), steps), options);
  ASSERT_EQ(phases[0].name, "mid double support");
  Conditions pushed;
  pushed.pushes = {push(phases[0].at, {0, 1, 0}, 2.1)};
  EXPECT_EQ(run_viip(steps, pushed).result.outcome, Outcome::stands);
}

// First DTAD controls, then VIIP walks ahead, and then DTAD continues with its keys at the place of
// the feet.
TEST(ViipHoap1, PhasesPassTheRobotBetweenDtadAndViip) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  const double first = pattern.duration(), wait = 4.5;
  Pattern again = pattern;
  pattern.phases.push_back({first + wait, Support::both, {}, walk(4, 0.08)});
  // The same steps follow once more: footholds continue from where the first ones ended.
  const double x = again.phases[again.phases.size() - 2].swing->to.position.x();
  for (Phase& phase : again.phases) {
    phase.until += first + wait;
    if (phase.swing) phase.swing->to.position.x() += x;
    pattern.phases.push_back(phase);
  }
  for (Keyframe& key : again.keyframes)
    if (key.t > 0) {
      key.t += first + wait;
      pattern.keyframes.push_back(key);
    }
  Conditions dtad;
  dtad.controller = "dtad";
  const SimulationLog log = run_viip(pattern, dtad);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LE(log.result.final_cog_error, 0.003);
  const double period = 2.1 / std::sqrt(9.80665 / log.samples.front().cog.z());
  EXPECT_NEAR(log.samples.back().cog.x() - log.samples.front().cog.x(), 2 * x + 3 * 0.08 * period,
              0.02);
  // No quantity is discontinuous where the laws change.
  for (const double at : {first, first + wait}) {
    const size_t k = static_cast<size_t>(std::lround(1e3 * at));
    for (size_t i = k - 3; i < k + 3; ++i)
      EXPECT_LT((log.samples[i + 1].target - log.samples[i].target).cwiseAbs().maxCoeff(), 0.01);
  }
}

TEST(ViipHoap1, ComplaintsOfPhasesThatCannotBeCarried) {
  const auto complaint = [](const Pattern& pattern, const std::string& controller) {
    Conditions conditions;
    conditions.controller = controller;
    try {
      run_viip(pattern, conditions);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(complaint(goals({{0.3, CogGoal{}}, {2, walk(10, 0)}}), "viip").find("10 steps take"),
            std::string::npos);
  EXPECT_NE(complaint(stand_pattern(hoap1(), 1), "viip").find("no phase with \"viip\" goals"),
            std::string::npos);
}

}  // namespace
}  // namespace ayumi
