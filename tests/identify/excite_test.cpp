// The motions of `new excite` on the simulated robot: the constants of its servos are found from
// what its encoders would have measured, with noise and as counts.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/identify/identify.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/task/task.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

// Noise and size of a count [rad].
constexpr double kEncoderNoise = 2e-4, kEncoderCount = M_PI / 180 / 209;

bool is_arm(const std::string& joint) {
  return joint.find("shoulder") != std::string::npos || joint.find("elbow") != std::string::npos;
}

ServoDescription truth(const std::string& joint, double backlash) {
  ServoDescription servo;
  servo.kp = is_arm(joint) ? 500 : 900;
  servo.kd = is_arm(joint) ? 2 : 3;
  servo.viscous = is_arm(joint) ? 0.3 : 0.6;
  servo.coulomb = is_arm(joint) ? 0.12 : 0.25;
  servo.rotor_inertia = 0.003;
  servo.delay = 0.0034;
  servo.backlash = backlash;
  return servo;
}

RobotModel robot_with_servos(double backlash) {
  RobotDescription robot = hoap1().description();
  for (const Dof& dof : hoap1().dofs()) robot.servos[dof.name] = truth(dof.name, backlash);
  for (ActuatorProfile& profile : robot.profiles) profile.servos.clear();
  return RobotModel(robot);
}

/// The commands that the servos received, and the angles that the encoders measured, in a run
/// without a controller.
RecordedMotion recorded_run(const RobotModel& model, const Pattern& pattern) {
  SimulateOptions options;
  options.controller.type = ControllerKind::none;
  const SimulationLog log = simulate(model, sample_at_servo_period(model, pattern), options);
  RecordedMotion motion;
  const auto rows = static_cast<Eigen::Index>(log.samples.size());
  for (AngleTable* table : {&motion.command, &motion.measured}) {
    table->dt = log.dt;
    table->theta.resize(rows, model.dof_count());
    table->has.assign(static_cast<size_t>(model.dof_count()), 1);
    table->resolution = Eigen::VectorXd::Constant(model.dof_count(), kEncoderCount);
  }
  Random random(1);
  const auto counts = [](double angle) {
    return kEncoderCount * std::round(angle / kEncoderCount);
  };
  for (Eigen::Index k = 0; k < rows; ++k)
    for (int j = 0; j < model.dof_count(); ++j) {
      const SimulationSample& sample = log.samples[static_cast<size_t>(k)];
      motion.command.theta(k, j) = counts(sample.target[j]);
      motion.measured.theta(k, j) = counts(sample.state.theta[j] + kEncoderNoise * random.normal());
    }
  return motion;
}

void expect_covers(const ServoEstimate& estimate, double truth, const std::string& what) {
  EXPECT_LE(estimate.lower, truth) << what;
  EXPECT_GE(estimate.upper, truth) << what;
}

// A robot that cannot do a part of the motion gets the other parts.
TEST(ExcitePattern, HasOnlyThePartsThatAreAskedFor) {
  const auto has = [](const Pattern& pattern, const auto& is_in) {
    return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(), is_in);
  };
  const auto moves_a_foot = [](const Keyframe& key) { return key.feet[0] || key.feet[1]; };
  const auto moves_an_arm = [](const Keyframe& key) { return key.joints.contains("l_elbow"); };
  const Pattern arms = excite_pattern(hoap1(), 1, 1, {ExcitePart::other_joints}),
                squat = excite_pattern(hoap1(), 1, 1, {ExcitePart::squat}),
                whole = excite_pattern(hoap1());
  EXPECT_FALSE(has(arms, moves_a_foot));
  EXPECT_TRUE(has(arms, moves_an_arm));
  EXPECT_TRUE(has(squat, moves_a_foot));
  EXPECT_FALSE(has(squat, moves_an_arm));
  EXPECT_TRUE(has(whole, moves_a_foot) && has(whole, moves_an_arm));
  for (const Phase& phase : arms.phases) EXPECT_EQ(phase.support, Support::both);
  EXPECT_TRUE(judge(make_task(arms, hoap1(), "hoap1-strong")).good());
}

// kp is found to 10 % and the delay to half a millisecond wherever they are called known; every
// constant is within its interval, and kp is known for the joints that carry the robot.
TEST(ExciteRoundTrip, FindsTheServosOfTheSimulatedRobot) {
  const RobotModel model = robot_with_servos(0);
  IdentifyOptions options;
  options.threads = 2;
  // The motion is as large as `new excite` allows within the limits of the robot's motors.
  const Identification found =
      identify(model, recorded_run(model, excite_pattern(model, 0.5)), options, "m.csv");
  std::map<std::string, IdentifiedJoint> joints;
  for (const IdentifiedJoint& joint : found.joints) {
    joints[joint.joint] = joint;
    const ServoDescription servo = truth(joint.joint, 0);
    ASSERT_TRUE(joint.moved) << joint.joint;
    expect_covers(joint.kp, servo.kp, joint.joint + " kp");
    expect_covers(joint.damping, servo.kd + servo.viscous, joint.joint + " damping");
    expect_covers(joint.coulomb, servo.coulomb, joint.joint + " coulomb");
    EXPECT_EQ(joint.backlash.value, 0) << joint.joint;
    if (joint.kp.known) {
      EXPECT_NEAR(joint.kp.value, servo.kp, 0.1 * servo.kp) << joint.joint;
      EXPECT_FALSE(joint.delay_is_lag) << joint.joint;
      EXPECT_NEAR(joint.delay.value, servo.delay, 0.0005) << joint.joint;
    }
  }
  for (const std::string side : {"l_", "r_"})
    for (const std::string name : {"hip_roll", "hip_pitch", "knee"})
      EXPECT_TRUE(joints.at(side + name).kp.known) << side + name;
}

// The play of gears is found if the load changes from one flank to the other with weight: at the
// knees, which carry the robot and then the leg in the air.
TEST(ExciteBacklash, IsFoundAtTheKnees) {
  constexpr double kPlay = 0.01;  // play [rad]
  const RobotModel model = robot_with_servos(kPlay);
  IdentifyOptions options;
  options.threads = 2;
  RecordedMotion motion = recorded_run(model, excite_pattern(model, 0.5));
  // Only joints that have a command are identified. These are the legs, whose loads belong
  // together.
  for (int j = 0; j < model.dof_count(); ++j)
    if (is_arm(model.dofs()[static_cast<size_t>(j)].name))
      motion.command.has[static_cast<size_t>(j)] = 0;
  const Identification found = identify(model, motion, options, "m.csv");
  int knees = 0;
  for (const IdentifiedJoint& joint : found.joints) {
    if (!joint.joint.ends_with("knee")) continue;
    ++knees;
    EXPECT_NEAR(joint.backlash.value, kPlay, 0.2 * kPlay) << joint.joint;
  }
  EXPECT_EQ(knees, 2);
}

// On both feet, the legs may press against each other: no stiffness is reported.
TEST(ExciteRoundTrip, SaysThatTwoFeetDoNotShowTheLoad) {
  const RobotModel model = robot_with_servos(0);
  SquatParameters squat = squat_defaults(model);
  squat.cycles = 1;
  const Identification found =
      identify(model, recorded_run(model, squat_pattern(model, squat)), {}, "m.csv");
  for (const IdentifiedJoint& joint : found.joints) {
    if (!joint.moved) continue;
    EXPECT_FALSE(joint.kp.known) << joint.joint;
    EXPECT_EQ(joint.kp.lower, 0) << joint.joint;
    ASSERT_FALSE(joint.confounded.empty());
    EXPECT_NE(joint.confounded[0].find("record a motion that lifts each foot"), std::string::npos);
  }
}

}  // namespace
}  // namespace ayumi::test
