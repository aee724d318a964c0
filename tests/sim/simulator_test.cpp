// A copy of a Simulator is a branch: it has the same state and the same future, with a scenario of
// its own.
#include "ayumi/sim/simulator.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/error_message.hpp"

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

TEST(Simulator, SamplesThatAreSentAreThoseOfTheLog) {
  const Stand stand;
  const SimulationLog whole = simulate(stand.model, stand.series, stand.options);
  Simulator simulator(stand.model, stand.series, stand.options);
  std::vector<SimulationSample> sent;
  simulator.send_samples([&](const SimulationSample& sample) { sent.push_back(sample); });
  simulator.advance(kAll);
  SimulationLog log = simulator.take_log();
  EXPECT_TRUE(log.samples.empty());
  log.samples = std::move(sent);
  EXPECT_EQ(log_hash(log), log_hash(whole));
}

TEST(Simulator, BranchGoesOnToTheSameBits) {
  const Stand stand;
  const std::string expected = log_hash(simulate(stand.model, stand.series, stand.options));
  // The original run is not changed by the push of a branch, and the branches continue after it is
  // destroyed.
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
  EXPECT_EQ(a.torque.ratio, b.torque.ratio);
  EXPECT_TRUE(bare.take_log().samples.empty());
  EXPECT_EQ(kept.take_log().samples.size(), 801u);
}

// Every tenth tick is examined, and a robot that is pushed hard falls.
TEST(Simulator, GatheringTheVerdictAloneIsTheSameRun) {
  Stand stand;
  for (const ControllerKind controller : {ControllerKind::dtad, ControllerKind::none})
    for (const double impulse : {0.3, 6.0}) {
      stand.options.controller.type = controller;
      stand.options.scenario = {Stand::push(impulse)};
      Simulator whole(stand.model, stand.series, stand.options);
      Simulator verdict = whole;
      whole.keep_samples(false);
      verdict.gather_verdict_only();
      for (bool more = true; more;) {
        more = whole.advance(10);
        ASSERT_EQ(verdict.advance(10), more);
        ASSERT_EQ(verdict.tick(), whole.tick());
        ASSERT_EQ(verdict.fell(), whole.fell());
        ASSERT_EQ(verdict.state().theta, whole.state().theta) << whole.time();
        ASSERT_EQ(verdict.state().base.position, whole.state().base.position);
        ASSERT_EQ(verdict.plan().cog, whole.plan().cog);
        ASSERT_EQ(verdict.plan().state.theta, whole.plan().state.theta);
        const Estimate &a = verdict.last_estimate(), &b = whole.last_estimate();
        ASSERT_EQ(a.cog, b.cog);
        ASSERT_EQ(a.dcog, b.dcog);
        ASSERT_EQ(a.zmp, b.zmp);
        ASSERT_EQ(a.fz, b.fz);
        ASSERT_EQ(a.stance, b.stance);
        ASSERT_EQ(a.foot_tilt, b.foot_tilt);
        ASSERT_EQ(a.state.theta, b.state.theta);
        const SimulationSample &c = verdict.last_sample(), &d = whole.last_sample();
        ASSERT_EQ(c.cog, d.cog);
        ASSERT_EQ(c.zmp, d.zmp);
        ASSERT_EQ(c.fz, d.fz);
        ASSERT_EQ(c.reference_base.position, d.reference_base.position);
        ASSERT_EQ(c.reference_theta, d.reference_theta);
      }
      const SimulationResult a = verdict.result(), b = whole.result();
      EXPECT_EQ(a.outcome, b.outcome);
      EXPECT_EQ(a.outcome == Outcome::fell, impulse > 1) << name_of(controller);
      EXPECT_EQ(a.fell_at, b.fell_at);
      EXPECT_EQ(a.max_tilt, b.max_tilt);
      EXPECT_EQ(a.final_cog_error, b.final_cog_error);
      EXPECT_EQ(a.final_speed, b.final_speed);
      EXPECT_EQ(a.zmp_amplitude, b.zmp_amplitude);
    }
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

// The COG is computed again from the logged posture and must be the logged one, with sensor noise
// and under a push.
TEST(Simulator, ALogRowHasPostureAndBaseOfOneTick) {
  Stand stand;
  stand.options.scenario = {Stand::push(0.8)};
  const SimulationLog log = simulate(stand.model, stand.series, stand.options);
  RobotData data(stand.model);
  double fastest = 0;
  for (const SimulationSample& s : log.samples) {
    RobotState posture;
    posture.base = s.reference_base;
    posture.theta = s.reference_theta;
    posture.dtheta = Eigen::VectorXd::Zero(s.reference_theta.size());
    update_positions(stand.model, posture, data);
    EXPECT_LT((data.cog - s.reference_cog).norm(), 1e-12);
  }
  for (size_t k = 1; k < log.samples.size(); ++k)
    fastest = std::max(
        fastest, (log.samples[k].reference_cog - log.samples[k - 1].reference_cog).norm() / log.dt);
  EXPECT_GT(fastest, 0.01);  // the robot moves, so that a row that mixed two ticks would be noticed
}

TEST(Simulator, ServosReceiveWholeCountsWhereSensorsAreSimulated) {
  Stand stand;
  const SimulationLog counted = simulate(stand.model, stand.series, stand.options);
  stand.options.sensor_noise = false;
  const SimulationLog exact = simulate(stand.model, stand.series, stand.options);
  const auto off = [&](const SimulationLog& log) {
    double most = 0;
    for (const SimulationSample& s : log.samples)
      for (int j = 0; j < stand.model.dof_count(); ++j) {
        const double counts =
            s.target[j] * stand.model.dofs()[j].encoder.counts_per_degree * 180 / M_PI;
        most = std::max(most, std::abs(counts - std::round(counts)));
      }
    return most;
  };
  EXPECT_LT(off(counted), 1e-6);
  EXPECT_GT(off(exact), 0.1);
}

// Dry and viscous friction that the sidecar states has almost no effect on the unpushed walk.
TEST(Friction, OfTheSidecarIsFedForward) {
  const RobotModel smooth = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const auto rms = [](const RobotModel& model, ControllerKind kind, const char* pattern) {
    const CommandSeries series = sample(model, read_pattern(pattern));
    SimulateOptions options;
    options.controller.type = kind;
    const SimulationLog log = simulate(model, series, options);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    return log.result.zmp_tracking_rms;
  };
  const auto with = [&](double coulomb, double viscous) {
    RobotDescription description = smooth.description();
    for (auto& [joint, servo] : description.servos) {
      servo.coulomb = coulomb;
      servo.viscous = viscous;
    }
    return RobotModel(std::move(description));
  };
  const RobotModel dry = with(0.1, 0), thick = with(0.05, 0.3);
  for (const auto& [kind, pattern] :
       {std::pair{ControllerKind::dtad, AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"},
        std::pair{ControllerKind::viip, AYUMI_SOURCE_DIR "/patterns/hoap1_viip_shift.json"}}) {
    const double without = rms(smooth, kind, pattern);
    EXPECT_LT(rms(dry, kind, pattern), 1.05 * without) << pattern;
    EXPECT_LT(rms(thick, kind, pattern), 1.05 * without) << pattern;
  }
}

// The encoders of the ankles are wrong by about a degree: those of one foot, of both feet, and
// about both axes.
TEST(StandingCalibration, FindsTheOffsetsOfTheAnkles) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const CommandSeries series = sample(model, stand_pattern(model, 0.6));
  constexpr double kDegree = M_PI / 180;
  using Offsets = std::vector<std::pair<std::string, double>>;
  for (const Offsets& truth : {Offsets{{"l_ankle_pitch", 1.0}}, Offsets{{"r_ankle_roll", -1.2}},
                               Offsets{{"l_ankle_roll", 0.8}, {"r_ankle_pitch", -1.0}}}) {
    SimulateOptions options;
    options.controller.type = ControllerKind::dtad;
    for (const auto& [joint, degrees] : truth)
      options.scenario.push_back(
          {.duration = 100, .what = EncoderOffset{.joint = joint, .offset = degrees * kDegree}});
    const SimulationLog log = simulate(model, series, options);
    SCOPED_TRACE(truth[0].first);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_LT(log.result.max_tilt, 0.005);
    EXPECT_LT(log.result.zmp_tracking_rms, 0.003);
    size_t found = 0;
    for (const SimulationEvent& event : log.events) {
      if (event.kind != EventKind::calibration) continue;
      ++found;
      bool named = false;
      for (const auto& [joint, degrees] : truth) {
        const size_t at = event.text.find(joint + " reads ");
        if (at == std::string::npos) continue;
        named = true;
        EXPECT_NEAR(std::stod(event.text.substr(at + joint.size() + 7)), std::abs(degrees), 0.15);
        EXPECT_NE(event.text.find(degrees > 0 ? "deg too much" : "deg too little"),
                  std::string::npos)
            << event.text;
      }
      EXPECT_TRUE(named) << event.text;
    }
    EXPECT_EQ(found, truth.size());
  }
}

// The only error that the noise of the sensors leaves is the bias of the IMU, 5 mrad about x and y.
TEST(StandingCalibration, FindsAnOffsetInTheNoiseOfTheSensors) {
  Stand stand;
  stand.options.scenario = {
      {.duration = 100, .what = EncoderOffset{.joint = "l_ankle_roll", .offset = 0.03}}};
  const SimulationLog log = simulate(stand.model, stand.series, stand.options);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.max_tilt, 0.012);
  const std::string start = "the encoder of l_ankle_roll reads ";
  double found = 0;
  for (const SimulationEvent& event : log.events)
    if (event.text.rfind(start, 0) == 0) found = std::stod(event.text.substr(start.size()));
  EXPECT_NEAR(found, 0.03 * 180 / M_PI, 0.45);
}

// If a slope of the ground explains the readings as well, only the text of the event changes.
TEST(StandingCalibration, BothAnklesAlikeMayBeASlope) {
  Stand stand;
  stand.options.sensor_noise = false;
  const SimulationLog level = simulate(stand.model, stand.series, stand.options);
  stand.options.world.slope = {0, 0.017};
  const SimulationLog log = simulate(stand.model, stand.series, stand.options);
  int words = 0;
  for (const SimulationEvent& event : log.events) {
    if (event.kind != EventKind::calibration) continue;
    ++words;
    EXPECT_NE(event.text.find("or the ground slopes"), std::string::npos) << event.text;
  }
  EXPECT_EQ(words, 2);
  // An offset would turn the ankles by 0.017 rad.
  EXPECT_LT((log.samples[0].target - level.samples[0].target).cwiseAbs().maxCoeff(), 0.008);
}

TEST(StandingCalibration, LeavesARobotAloneThatStandsOnItsSoles) {
  const Stand stand;
  for (const SimulationEvent& event : simulate(stand.model, stand.series, stand.options).events)
    EXPECT_NE(event.kind, EventKind::calibration) << event.text;
}

// A joint of this robot unit stands beyond what its encoder reads by the offset. The controller of
// the unit knows this, so the unit moves as a robot without offsets does. A unit with other offsets
// than the controller assumes stands wrong by exactly the difference.
TEST(Simulator, OffsetsThatTheFileStatesDoNotChangeTheMotion) {
  const Stand stand;
  const double offset = 0.01;
  RobotDescription description = stand.model.description();
  for (const char* joint : {"l_knee", "r_ankle_roll", "l_elbow"})
    description.servos.at(joint).offset = offset;
  const RobotModel unit(description);
  const auto furthest = [](const SimulationLog& a, const SimulationLog& b) {
    double distance = 0;
    for (size_t k = 0; k < a.samples.size(); ++k)
      distance = std::max(
          distance, (a.samples[k].state.theta - b.samples[k].state.theta).cwiseAbs().maxCoeff());
    return distance;
  };
  SimulateOptions options = stand.options;
  options.sensor_noise = false;
  const SimulationLog plain = simulate(stand.model, stand.series, options);
  const SimulationLog own = simulate(unit, stand.series, options);
  ASSERT_EQ(own.samples.size(), plain.samples.size());
  EXPECT_LT(furthest(own, plain), 1e-9);  // rounding of target minus offset
  // In open loop, nothing compensates for the offset of a unit that the file does not state. The
  // elbow carries no load that depends on its angle by more than a share of its error.
  options.scenario.clear();
  options.controller.type = ControllerKind::none;
  const SimulationLog expected = simulate(stand.model, stand.series, options);
  const RobotUnit individual{unit, unit.limits()};
  options.unit = &individual;
  const SimulationLog other = simulate(stand.model, stand.series, options);
  const int elbow = unit.find_dof("l_elbow");
  EXPECT_NEAR(other.samples.back().state.theta[elbow] - expected.samples.back().state.theta[elbow],
              offset, 0.01 * offset);
}

TEST(Simulate, RefusesANumberOfSubstepsOutOfBounds) {
  const Stand stand;
  for (const int substeps : {0, 101, std::numeric_limits<int>::max()}) {
    SimulateOptions options;
    options.controller.type = ControllerKind::none;
    options.substeps = substeps;
    EXPECT_EQ(test::error_message([&] { simulate(stand.model, stand.series, options); },
                                  ErrorCode::usage),
              "the number of integrator steps per servo period is " + text::exact(substeps) +
                  "; it must be from 1 to 100");
  }
}

}  // namespace
}  // namespace ayumi
