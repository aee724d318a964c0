// The robot's energy changes by the work that servos, ground, pushes and joint friction do on it:
// the difference decreases with the step.

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "tests/support/block.hpp"
#include "tests/support/mechanical_energy.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

double sum(const EnergyBalance& w) { return w.servos + w.contacts + w.outside + w.joints; }

// A block falls 20 mm and comes to rest: the ground takes m g h, all of it at the impact. The step
// of the impact begins somewhere in the last v dt of the fall, and gravity acts during it.
TEST(Energy, TheGroundTakesWhatAFallingBlockHad) {
  const RobotModel model(test::block_description({0.2, 0.1, 0.04}, 2.0));
  for (const double dt : {1e-3, 1.25e-4}) {
    Plant plant(model, model.limits(), World{});
    RobotState s = model.rest_state();
    s.base.position.z() = 0.04;
    plant.set_state(s);
    double taken = 0;
    for (int i = 0; i < std::lround(0.5 / dt); ++i)
      taken += plant.step(VectorXd(0), {}, dt).work.contacts;
    const double weight = 2.0 * kGravity, v = std::sqrt(2 * kGravity * 0.02);
    EXPECT_NEAR(taken, -weight * 0.02, 1.02 * weight * 0.5 * v * dt) << dt;
  }
}

// The energy of sliding is friction times distance.
TEST(Energy, FrictionTakesForceTimesWay) {
  const RobotModel model(test::block_description({0.2, 0.1, 0.04}, 2.0));
  Plant plant(model, model.limits(), World{.friction = 0.3});
  RobotState s = model.rest_state();
  s.base.position.z() = 0.02;
  s.base_velocity.x() = 1;
  plant.set_state(s);
  double taken = 0;
  for (int i = 0; i < 600; ++i) taken += plant.step(VectorXd(0), {}, 1e-3).work.contacts;
  EXPECT_NEAR(taken, -0.5 * 2.0, 1e-3);
}

/// HOAP-1 squats and is pushed, and its joints have friction: the result is the largest difference
/// of energy and work.
double imbalance(const RobotModel& model, double h) {
  const CommandSample start = test::standing(model, 0).samples[0];
  Plant plant(model, model.limits(), World{});
  plant.set_state(start.state);
  const double before = test::mechanical_energy(model, start.state);
  StepInput input;
  input.joints.resize(static_cast<size_t>(model.dof_count()), {.coulomb = 0.05, .viscous = 0.02});
  const auto& servos = model.limits().servo;
  double worst = 0, done = 0;
  for (int i = 0; i < std::lround(0.6 / h); ++i) {
    const double t = i * h;
    VectorXd target = start.state.theta;
    const double bend = 0.15 * test::minimum_jerk(t / 0.4);
    for (int j = 0; j < model.dof_count(); ++j) {
      const std::string& name = model.dofs()[j].name;
      if (name.ends_with("knee")) target[j] += 2 * bend;
      if (name.ends_with("hip_pitch") || name.ends_with("ankle_pitch")) target[j] -= bend;
    }
    input.wrenches.clear();
    if (t > 0.2 && t < 0.25) {
      ExternalWrench push;
      push.force = Vector3d(5, 3, 0);
      input.wrenches.push_back(push);
    }
    const StepReport& report = plant.step(target, input, h);
    done += sum(report.work);
    double energy = test::mechanical_energy(model, plant.state()) - before;
    for (int j = 0; j < model.dof_count(); ++j) {  // rotors turn at the rates of their motors
      const double motor = report.motor_rate[j], joint = plant.state().dtheta[j];
      energy +=
          0.5 * servos[static_cast<size_t>(j)].rotor_inertia * (motor * motor - joint * joint);
    }
    worst = std::max(worst, std::abs(energy - done));
  }
  return worst;
}

class JointEnergy : public testing::TestWithParam<bool> {};

TEST_P(JointEnergy, BalanceClosesWithTheStep) {
  RobotDescription robot = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1").description();
  for (auto& [joint, servo] : robot.servos) {
    if (!GetParam()) continue;
    servo.backlash = 0.01;
    servo.coulomb = 0.02;
    servo.delay = 0.0037;
    servo.load.external = 0.05;
  }
  const RobotModel model(robot);
  const double whole = imbalance(model, 1e-3), half = imbalance(model, 5e-4),
               quarter = imbalance(model, 2.5e-4);
  RecordProperty("joules", std::to_string(whole));
  EXPECT_LT(whole, 0.02);
  EXPECT_LT(half, 0.65 * whole);
  EXPECT_LT(quarter, 0.65 * half);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithGears, JointEnergy, testing::Bool());

}  // namespace
}  // namespace ayumi
