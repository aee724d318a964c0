// The effect of every disturbance on a standing HOAP-1, in N, m and s.

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/simulator.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using test::hoap1;

const CommandSeries& stand() {
  static const CommandSeries series = test::standing(hoap1(), 2.0);
  return series;
}

int dof(const std::string& name) {
  const std::vector<std::string> names = hoap1().dof_names();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// A disturbance from 0.5 s on, for 1 s.
template <typename What>
Disturbance lasting(const What& what) {
  return {.at = 0.5, .duration = 1.0, .what = what};
}

SimulationLog run(const std::vector<Disturbance>& scenario, double friction = 0.8,
                  double settle = 0) {
  SimulateOptions options;
  options.controller.type = ControllerKind::none;
  options.profile = "hoap1-soft";  // it comes to rest where a disturbance has moved it
  options.settle = settle;
  options.scenario = scenario;
  options.world.friction = friction;
  return simulate(hoap1(), stand(), options);
}

const SimulationSample& at(const SimulationLog& log, double t) {
  return log.samples[static_cast<size_t>(std::lround(t / log.dt))];
}

TEST(Payload, WeighsWhileItIsCarried) {
  const Payload load{.on = "r_forearm", .point = {0, 0, -0.05}, .mass = 0.3};
  const SimulationLog log = run({lasting(load)});
  const double weight = hoap1().mass() * kGravity;
  EXPECT_NEAR(at(log, 0.499).fz, weight, 1e-3);
  EXPECT_GT(std::abs(at(log, 0.501).fz - weight), 1e-3);  // it has an effect in the first step
  EXPECT_NEAR(at(log, 1.45).fz, weight + 0.3 * kGravity, 0.05);
  EXPECT_NEAR(at(log, 1.99).fz, weight, 0.05);
  // The payload moves the ZMP to its own side, by the moments about the ground.
  const RobotModel& model = hoap1();
  RobotData data(model);
  const SimulationSample& s = at(log, 1.45);
  update_positions(model, s.state, data);
  const Eigen::Isometry3d hand = link_pose(model, data, model.find_link("r_forearm"));
  const Vector3d together =
      (model.mass() * data.cog + 0.3 * (hand * load.point)) / (model.mass() + 0.3);
  EXPECT_NEAR(s.zmp.y(), together.y(), 2e-4);
  EXPECT_NEAR(s.cog.y(), together.y(), 1e-9);
  ASSERT_EQ(log.events.size(), 2u);
  EXPECT_EQ(log.events[0].t, 0.5);
  EXPECT_EQ(log.events[0].text, "payload of 0.3 kg on r_forearm");
  EXPECT_EQ(log.events[1].t, 1.5);
  EXPECT_EQ(log.events[1].text, "payload of 0.3 kg on r_forearm: over");
}

// The robot has settled under a payload from the start when the run begins.
TEST(Payload, FromTheStartIsThereWhileTheRobotSettles) {
  Disturbance d = lasting(Payload{.on = "r_forearm", .mass = 0.3});
  d.at = 0;
  const SimulationLog log = run({d});
  EXPECT_NEAR(at(log, 0).fz, (hoap1().mass() + 0.3) * kGravity, 0.2);
}

// The pull is one that ground of friction 0.8 holds and ground of 0.1 does not.
TEST(Friction, LetsTheRobotSlideOnce) {
  const Disturbance pull = lasting(Push{.kind = PushKind::force,
                                        .magnitude = 0.2 * hoap1().mass() * kGravity,
                                        .on = "l_foot",
                                        .direction = Vector3d::UnitY()});
  const Disturbance slippery{.at = 0.8, .duration = 0.2, .what = FrictionChange{0.1}};
  const SimulationLog log = run({pull, slippery});
  EXPECT_LT(std::abs(at(log, 0.79).cog.y() - at(log, 0.49).cog.y()), 0.005);
  const double slid = at(log, 1.0).cog.y() - at(log, 0.79).cog.y();
  // Both feet slide together from rest: a = (0.2 - 0.1) g, minus the sway of the upper body.
  EXPECT_NEAR(slid, 0.5 * 0.1 * kGravity * 0.04, 0.010);
  EXPECT_GT(slid, 0.010);
}

// A servo holds a torque with a sag of torque / kp; with half of the gain, the sag doubles.
TEST(GainLoss, SagsByTorqueOverGain) {
  const SimulationLog log = run({lasting(GainLoss{.joint = "l_knee", .share = 0.5})});
  const int knee = dof("l_knee");
  const double kp = hoap1().limits("hoap1-soft").servo[static_cast<size_t>(knee)].kp;
  for (const auto& [t, gain] : {std::pair{0.49, kp}, {1.45, 0.5 * kp}, {1.95, kp}}) {
    const SimulationSample& s = at(log, t);
    ASSERT_GT(std::abs(s.torque[knee]), 0.1);
    EXPECT_NEAR(s.target[knee] - s.state.theta[knee], s.torque[knee] / gain,
                1e-4 * std::abs(s.torque[knee]) / gain + 1e-7);
  }
}

// Servo and controller read the same wrong angle: the joint is displaced by the offset, and neither
// notices it.
TEST(EncoderOffset, MovesTheJointUnseen) {
  const std::string joint = hoap1().dof_names().back();
  SimulateOptions options;
  options.controller.type = ControllerKind::none;
  options.scenario = {lasting(EncoderOffset{.joint = joint, .offset = 0.02})};
  const int j = dof(joint);
  Simulator simulator(hoap1(), stand(), options);
  simulator.advance(490);
  const double before = simulator.state().theta[j];
  const double seen_before = simulator.last_estimate().state.theta[j];
  simulator.advance(900);
  EXPECT_NEAR(simulator.state().theta[j] - before, -0.02, 2e-4);
  EXPECT_NEAR(simulator.last_estimate().state.theta[j] - seen_before, 0, 2e-4);
}

TEST(JointFriction, HoldsWhatTheServoCannotMove) {
  const RobotModel& model = hoap1();
  const int j = model.dof_count() - 1;
  const double kp = model.limits().servo[static_cast<size_t>(j)].kp;
  StepInput input;
  input.joints.resize(static_cast<size_t>(model.dof_count()));
  for (const double coulomb : {0.0, 5.0}) {
    input.joints[static_cast<size_t>(j)].coulomb = coulomb;
    Plant plant(model, model.limits(), World{});
    plant.set_state(stand().samples[0].state);
    Eigen::VectorXd target = stand().samples[0].state.theta;
    for (int i = 0; i < 400; ++i) plant.step(target, input, 1e-3);
    const double before = plant.state().theta[j];
    target[j] += 0.5 / kp;  // the servo asks for half a newton metre
    // In 0.1 s, joints that stick creep by 1e-4 rad/s under a tenth of their dry friction.
    for (int i = 0; i < 100; ++i) plant.step(target, input, 1e-3);
    const double moved = (plant.state().theta[j] - before) * kp / 0.5;
    EXPECT_NEAR(moved, coulomb > 0 ? 0 : 1, 0.05);
  }
}

// A stiff servo far from its target asks for a rate that no motor reaches. The joint nevertheless
// moves at full torque, then at the speed limit, and arrives.
TEST(TorqueLimit, AFarTargetIsReachedAtTheSpeedLimit) {
  const RobotModel& model = hoap1();
  const ActuatorLimits& limits = model.limits("hoap1");
  const int j = model.find_dof("r_shoulder_pitch");
  RobotState state = model.rest_state();
  state.base.position.z() = 100;
  for (const double dt : {1e-3, 2.5e-4}) {
    Plant plant(model, limits, World{});
    plant.set_state(state);
    Eigen::VectorXd target = state.theta;
    target[j] -= 1.0;
    double fastest = 0;
    for (int i = 0; i < std::lround(0.3 / dt); ++i) {
      const double torque = plant.step(target, {}, dt).torque[j];
      const double rate = -plant.state().dtheta[j];
      fastest = std::max(fastest, rate);
      if (rate < 0.95 * limits.speed[j] && fastest < limits.speed[j]) {
        EXPECT_EQ(torque, -limits.peak_torque[j]);
      }
      // The momentum of the base moves the arm on, and the motor does not.
      if (rate > 1.1 * limits.speed[j]) {
        EXPECT_GE(torque, 0);
      }
    }
    EXPECT_GT(fastest, limits.speed[j]) << dt;
    EXPECT_NEAR(plant.state().theta[j], target[j], 0.01) << dt;
  }
}

// Every reading is three ticks older than without latency; the motion (open loop) is the same.
TEST(Latency, DelaysEveryReading) {
  const Disturbance push{.at = 0.6, .duration = 0.02, .what = Push{.magnitude = 0.2}};
  const Disturbance latency = lasting(Latency{0.003});
  const SimulationLog late = run({push, latency}), now = run({push});
  for (const size_t k : {700u, 900u, 1400u}) {
    EXPECT_EQ(late.samples[k].cog, now.samples[k].cog);
    EXPECT_EQ(late.samples[k].measured_fz, now.samples[k - 3].measured_fz);
  }
  for (const size_t k : {400u, 1600u})
    EXPECT_EQ(late.samples[k].measured_fz, now.samples[k].measured_fz);
}

TEST(SensorBias, TurnsTheAttitudeAndLoadsTheCells) {
  SimulateOptions options;
  options.controller.type = ControllerKind::none;
  options.scenario = {lasting(SensorBias{.tilt = {0, 0.02}, .load = 0.5})};
  Simulator simulator(hoap1(), stand(), options);
  simulator.advance(490);
  const Estimate before = simulator.last_estimate();
  simulator.advance(500);
  const Estimate after = simulator.last_estimate();
  EXPECT_NEAR(after.state.base.attitude.angularDistance(before.state.base.attitude), 0.02, 1e-4);
  size_t cells = 0;
  for (Side side : {Side::left, Side::right}) cells += hoap1().sole(side).polygon.size();
  EXPECT_NEAR(after.fz - before.fz, 0.5 * static_cast<double>(cells), 0.01);
  options.true_state = true;
  Simulator knowing(hoap1(), stand(), options);
  knowing.advance(990);
  EXPECT_NEAR((knowing.last_estimate().cog - knowing.last_sample().cog).norm(), 0, 1e-12);
  EXPECT_NEAR(knowing.last_estimate().fz, knowing.last_sample().fz, 1e-12);
}

TEST(Floor, CarriesAndTiltsTheRobot) {
  const SimulationLog log = run({lasting(FloorPath{.tilt = {0, 0.03}, .shift = {0, 0.02, 0.01}})});
  const auto sole = [&](double t) {
    RobotData data(hoap1());
    update_positions(hoap1(), at(log, t).state, data);
    return sole_pose(hoap1(), data, Side::left);
  };
  const Eigen::Isometry3d before = sole(0.49), after = sole(1.99);
  const Vector3d expected =
      exp_rotation({0, 0.03, 0}) * before.translation() + Vector3d(0, 0.02, 0.01);
  EXPECT_LT((after.translation() - expected).norm(), 3e-4);
  EXPECT_NEAR(matrix_to_rpy(after.linear()).y(), 0.03, 5e-4);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.max_slip, 5e-4) << "the feet go with the floor";
}

Bump bump_under_the_left_foot() {
  return {.foot = Side::left,
          .place = hoap1().sole(Side::left).center,
          .radius = 0.015,
          .height = 0.003};
}

TEST(Bump, LiftsTheFootItRisesUnder) {
  const Eigen::Vector2d place = hoap1().sole(Side::left).center;
  const SimulationLog log = run({lasting(bump_under_the_left_foot())});
  RobotData data(hoap1());
  const auto height = [&](double t) {  // height of the sole over the middle of the bump
    update_positions(hoap1(), at(log, t).state, data);
    return (sole_pose(hoap1(), data, Side::left) * Vector3d(place.x(), place.y(), 0)).z();
  };
  EXPECT_NEAR(height(0.49), 0, 1e-4);
  EXPECT_NEAR(height(1.4), 0.003, 4e-4);
  EXPECT_NEAR(height(1.99), 0, 2e-4);
  EXPECT_NEAR(at(log, 1.4).fz, hoap1().mass() * kGravity, 0.3);
}

TEST(Bump, FromTheStartHasBeenThereBefore) {
  const Eigen::Vector2d place = hoap1().sole(Side::left).center;
  Disturbance d = lasting(bump_under_the_left_foot());
  d.at = 0;
  const SimulationLog log = run({d}, 0.8, 1.5);
  RobotData data(hoap1());
  const auto height = [&](double t) {
    update_positions(hoap1(), at(log, t).state, data);
    return (sole_pose(hoap1(), data, Side::left) * Vector3d(place.x(), place.y(), 0)).z();
  };
  EXPECT_NEAR(height(0), 0.003, 4e-4);
  for (double t = 0; t < 0.1; t += 0.002)
    EXPECT_NEAR(height(t), height(0), 2e-4) << "it comes up again at " << t;
  EXPECT_NEAR(height(1.99), 0, 2e-4);
}

TEST(Scenario, UnknownJointsAreNamed) {
  try {
    run({lasting(GainLoss{.joint = "l_kneee", .share = 0.5})});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no joint 'l_kneee'; did you mean 'l_knee'"),
              std::string::npos)
        << error.what();
  }
}

// In the log, the energy that gravity gives in a fall becomes kinetic energy, to the order of the
// step.
TEST(Energy, IsKeptInFreeFlight) {
  CommandSeries series = stand();
  for (CommandSample& s : series.samples) s.state.base.position.z() += 5;
  SimulateOptions options;
  options.controller.type = ControllerKind::none;
  Simulator simulator(hoap1(), series, options);
  simulator.advance(1);
  const double speed = simulator.last_sample().dcog.z();
  EXPECT_LT(speed, -3);  // it has fallen since the servos were switched on
  EXPECT_NEAR(
      simulator.last_sample().energy - simulator.last_sample().cog.z() * hoap1().mass() * kGravity,
      0.5 * hoap1().mass() * speed * speed, 0.02);
}

}  // namespace
}  // namespace ayumi
