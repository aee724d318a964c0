// Servos are compared with closed forms, and with the same joint integrated in steps of 2 us.

#include "ayumi/sim/servo.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/sensors.hpp"
#include "tests/support/one_joint.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::VectorXd;
using test::kFlywheel;
using test::kHold;
using test::OneJoint;

/// Error of the Stribeck curve, which is computed in single precision [N m].
constexpr double kPart = 1e-7;

/// Largest error of the plant at steps of 1 ms [rad]. Derived: the flywheels turn at up to 2 rad/s,
/// and a law taken at the end of a step is at most one step late.
constexpr double kOneStep = 2.1e-3;

OneJoint joint_with(const ServoDescription& servo) { return {.name = "joint", .servo = servo}; }

/// A joint on Ayumi's plant.
struct Rig {
  explicit Rig(const OneJoint& joint) : model(test::model_of(joint)), plant(fresh()) {}
  explicit Rig(const ServoDescription& servo) : Rig(joint_with(servo)) {}
  Plant fresh() const {
    Plant plant(model, model.limits(), World{});
    RobotState start = model.rest_state();
    start.base.position.z() = 1000;
    plant.set_state(start);
    return plant;
  }
  const StepReport& step(double target, double load = 0, double dt = kHold) {
    return plant.step(VectorXd::Constant(1, target), test::input_of(load), dt);
  }
  void rest(double target, double load = 0, double time = 3) {
    for (long k = 0; k < std::lround(time / kHold); ++k) step(target, load);
  }
  double theta() const { return plant.state().theta[0]; }
  double rate() const { return plant.state().dtheta[0]; }

  RobotModel model;
  Plant plant;
};

class ServoForm : public testing::TestWithParam<OneJoint> {};

// The error of the plant is that of its integrator: it decreases with the step.
TEST_P(ServoForm, MovesAsInSmallSteps) {
  const OneJoint& joint = GetParam();
  const RobotModel model = test::model_of(joint);
  const test::JointTrace fine = test::fine_simulation(joint);
  const auto error = [&](int parts) {
    Plant plant(model, model.limits(), World{});
    return test::largest_difference(test::simulate(joint, model, plant, parts).theta, fine.theta);
  };
  const double whole = error(1);
  EXPECT_LT(whole, kOneStep);
  EXPECT_LT(error(5), 0.3 * whole);
}

TEST_P(ServoForm, ACopyContinuesToTheSameBits) {
  const OneJoint& joint = GetParam();
  Rig rig(joint), again(joint);
  const auto run = [&](Plant& plant, int from, int to) {
    for (int k = from; k < to; ++k)
      plant.step(VectorXd::Constant(1, joint.target(k * kHold)),
                 test::input_of(joint.load(k * kHold)), kHold);
  };
  run(rig.plant, 0, 400);
  Plant copy = rig.plant;
  run(rig.plant, 400, 800);
  run(copy, 400, 800);
  run(again.plant, 0, 800);
  // set_state() forgets the targets that the servo has received.
  again.plant.set_state(again.fresh().state());
  run(again.plant, 0, 800);
  for (const Plant* other : {&copy, &again.plant}) {
    EXPECT_EQ(other->state().theta, rig.plant.state().theta);
    EXPECT_EQ(other->state().dtheta, rig.plant.state().dtheta);
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, ServoForm, testing::ValuesIn(test::servo_forms()),
                         [](const auto& form) { return form.param.name; });

// The delayed target of a step is the mean of the held targets over the time of the step, shifted
// back by the delay. The test sums it in steps of 10 us.
TEST(ServoDelay, IsTheMeanOfTheTargetsOfTheDelayAgo) {
  constexpr double kDelay = 0.0037, kFine = 1e-5;
  test::Random random(7);
  for (const std::vector<double>& steps :
       {std::vector<double>{1e-3}, {5e-4}, {2e-3}, {1e-2}, {1e-3, 5e-4, 5e-4, 2e-3, 1e-4}}) {
    TargetDelay delay({{.delay = kDelay}, {.delay = 0}, {.delay = 0.004}});
    std::vector<double> held;  // target at every 10 us since the start
    for (int k = 0; k < 60; ++k) {
      const double dt = steps[static_cast<size_t>(k) % steps.size()];
      const double target = random.uniform();
      const auto parts = std::lround(dt / kFine);
      const auto start = static_cast<long>(held.size());
      held.insert(held.end(), static_cast<size_t>(parts), target);
      const VectorXd& now = delay.step(VectorXd::Constant(3, target), dt);
      for (const auto& [joint, late] : {std::pair{0, kDelay}, {2, 0.004}}) {
        double sum = 0;
        for (long i = start; i < start + parts; ++i)
          sum += held[static_cast<size_t>(std::max(0L, i - std::lround(late / kFine)))];
        EXPECT_NEAR(now[joint], sum / static_cast<double>(parts), 1e-12) << k;
      }
      EXPECT_EQ(now[1], target);
    }
  }
}

// On a ramp, a joint is behind the target by rate times (delay + kd/kp), for any step.
TEST(ServoDelay, OfARampIsTheSameForEveryStep) {
  constexpr double kRate = 0.5;
  ServoDescription servo = test::plain_servo();
  servo.delay = 0.0037;
  for (const double dt : {5e-4, 1e-3, 2e-3}) {
    Rig rig(servo);
    double target = 0;
    for (long k = 0; k < std::lround(2 / dt); ++k)
      rig.step(target = kRate * static_cast<double>(k) * dt, 0, dt);
    EXPECT_NEAR(target - rig.theta(), kRate * servo.lag(), 1e-9) << dt;
    EXPECT_NEAR(servo.lag(), 0.0037 + 0.05, 1e-12);
  }
}

// There is no answer before the delay has passed; after it, the answer is that of a servo without
// delay.
TEST(ServoDelay, OfAStepIsAnAnswerThatComesLater) {
  ServoDescription late = test::plain_servo();
  late.delay = 0.004;
  Rig delayed(late), prompt(test::plain_servo());
  for (Rig* rig : {&delayed, &prompt}) rig->step(0);
  std::vector<double> answers;
  for (int k = 0; k < 200; ++k) {
    delayed.step(0.2);
    if (k < 4) {
      EXPECT_LT(std::abs(delayed.theta()), 1e-15);
    }
    if (k >= 4) {
      EXPECT_NEAR(delayed.theta(), answers[static_cast<size_t>(k - 4)], 1e-12);
    }
    prompt.step(0.2);
    answers.push_back(prompt.theta());
  }
}

// With P control of the position with gain 20 1/s, the speed stays at its bound, and then the error
// decays.
TEST(ServoSpeedLoop, TurnsAtItsBoundThenDecays) {
  ServoDescription servo{.kp = 20 * 2.0, .kd = 2, .rotor_inertia = 0.01};
  servo.speed_command_limit = 0.5;
  Rig rig(servo);
  for (int k = 0; k < 500; ++k) rig.step(1);
  EXPECT_NEAR(rig.rate(), 0.5, 1e-6);
  // Inertia / speed_gain is the time to reach it.
  EXPECT_NEAR(rig.theta(), 0.5 * (0.5 - 0.06 / 2.0), 2e-3);
  rig.rest(1);
  EXPECT_NEAR(rig.theta(), 1, 1e-9);
}

// A load that grows by 1 N m/s begins to move the joint when it exceeds coulomb + stribeck_torque.
TEST(ServoFriction, BreaksAwayAtItsLargestAndSlidesByItsCurve) {
  ServoDescription servo{.rotor_inertia = 0.01, .viscous = 0.3, .coulomb = 0.6};
  servo.stribeck_torque = 0.3;
  servo.stribeck_rate = 0.4;
  servo.stribeck_exponent = 1.4;
  Rig rig(servo);
  int k = 0;
  while (std::abs(rig.rate()) < 1.1e-3 && k < 2000) rig.step(0, 1e-3 * ++k);
  // Friction falls by 2 % at the rate up to which the joint sticks.
  EXPECT_NEAR(1e-3 * k, 0.9, 0.005);
  servo.kp = 600, servo.kd = 60;  // the servo pulls the joint along at a steady rate
  for (const double rate : {0.05, 0.2, 0.5, 1.5}) {
    Rig pulled(servo);
    for (int i = 0; i < 3000; ++i) pulled.step(rate * i * kHold);
    const double friction = 0.3 * rate + 0.6 + 0.3 * std::exp(-std::pow(rate / 0.4, 1.4));
    EXPECT_NEAR(pulled.rate(), rate, 1e-6);
    EXPECT_NEAR(pulled.step(rate * 3000 * kHold).torque[0], friction, 1e-4) << rate;
  }
}

// The friction models of BAM are computed by hand: t_m = 3 N m, t_e = -2 N m, at rest and at the
// Stribeck rate.
TEST(ServoFriction, IsThatOfTheModelsM1ToM6) {
  const auto friction = [](ServoDescription servo, double rate) {
    return dry_friction(servo, rate, 3, -2);
  };
  const double e = std::exp(-1);
  ServoDescription m{.coulomb = 0.1};
  EXPECT_NEAR(friction(m, 0), 0.1, kPart);  // model M1
  m.stribeck_torque = 0.05, m.stribeck_rate = 0.2, m.stribeck_exponent = 1.35;
  EXPECT_NEAR(friction(m, 0), 0.15, kPart);  // model M2
  EXPECT_NEAR(friction(m, -0.2), 0.1 + 0.05 * e, kPart);
  m.load = {.motor = 0.02, .external = 0.02};  // M4 at speed is M3
  EXPECT_NEAR(friction(m, 1e3), 0.1 + 0.02 * 5, kPart);
  m.load.motor_stribeck = m.load.external_stribeck = 0.03;  // model M4
  EXPECT_NEAR(friction(m, 0), 0.15 + 0.05 * 5, kPart);
  m.load = {.motor = 0.02, .external = 0.07, .motor_stribeck = 0.01, .external_stribeck = 0.04};
  EXPECT_NEAR(friction(m, 0), 0.15 + (0.06 + 0.14) + (0.03 + 0.08), kPart);  // model M5
  EXPECT_NEAR(friction(m, 0.2), 0.1 + 0.2 + e * (0.05 + 0.11), kPart);
  m.load.motor_quadratic = 0.005, m.load.external_quadratic = 0.003;
  EXPECT_NEAR(friction(m, 0), 0.15 + 0.2 + 0.11 + 0.003 * 4, kPart);  // M6: the motor drives
  EXPECT_NEAR(dry_friction(m, 0, 2, -3), 0.15 + 0.25 + 0.14 + 0.005 * 4, kPart);  // the load drives
  EXPECT_NEAR(dry_friction(m, 0, 3, 2), 0.15 + std::abs(0.14 - 0.06) + std::abs(0.08 - 0.03),
              kPart);  // both push the same way
}

// When a target turns back, the joint does not move over 2 friction / kp. Under a load, the
// friction also has a part proportional to the load.
TEST(ServoFriction, OfAHeldLoadWidensTheBandInWhichAJointStays) {
  constexpr double kLoad = -5, kRate = 0.01;  // load and rate [N m, rad/s]
  ServoDescription servo{.kp = 100, .kd = 5, .rotor_inertia = 0.01, .coulomb = 0.2};
  servo.load.external = 0.1;
  for (const double load : {0.0, kLoad}) {
    Rig rig(servo);
    double target = 0, lowest = 0, highest = 0;
    for (int k = 0; k < 8000; ++k) {
      target += (k < 4000 ? 1 : -1) * kRate * kHold;
      const double before = rig.theta();
      rig.step(target, load);
      const bool returns = rig.theta() - before < -0.5 * kRate * kHold;
      if (k == 3999) highest = target;
      if (k >= 4000 && returns && lowest == 0) lowest = target;
    }
    // At the turning point, the servo pulls with friction and kd rate, and returns half as fast.
    const double band = (2 * (0.2 + 0.1 * std::abs(load)) + 1.5 * 5 * kRate) / 100;
    EXPECT_NEAR(highest - lowest, band, 0.03 * band) << load;
  }
}

// A load that reverses moves the joint by the play and the gear's compliance, and the motor by its
// own compliance.
TEST(ServoBacklash, GivesWayByThePlay) {
  ServoDescription servo = test::plain_servo();
  servo.backlash = 0.02;
  servo.gear_stiffness = 500;
  Rig rig(servo);
  rig.rest(0.1, 1.5);
  const double joint = rig.theta(), motor = rig.step(0.1, 1.5).motor[0];
  rig.rest(0.1, -1.5);
  EXPECT_NEAR(joint - rig.theta(), 0.02 + 2 * 1.5 / 500 + 2 * 1.5 / 60, 1e-7);
  EXPECT_NEAR(motor - rig.step(0.1, -1.5).motor[0], 2 * 1.5 / 60, 1e-7);
}

// The joint of a slow triangle stands still at the turning point while the motor crosses the play.
TEST(ServoBacklash, IsTheHysteresisOfASlowTriangle) {
  ServoDescription servo{.kp = 400, .kd = 20, .rotor_inertia = 0.01};
  servo.backlash = 0.03;
  OneJoint joint = joint_with(servo);
  Rig rig(joint);
  constexpr double kRate = 0.05;  // rate of the target [rad/s]
  double target = 0, drag = 0;
  for (int k = 0; k < 6000; ++k) {
    target = kRate * kHold * (k < 3000 ? k : 6000 - k);
    drag = -0.4 * rig.rate();  // the joint lies on the flank that drives it
    rig.step(target, drag);
    const double lag = rig.step(target, drag, 1e-9).motor[0] - rig.theta();
    if (k == 2900) {
      EXPECT_NEAR(lag, 0.015, 1e-4);
    }
    if (k == 3100) {
      EXPECT_LT(std::abs(lag), 0.0151);
    }
    if (k == 5900) {
      EXPECT_NEAR(lag, -0.015, 1e-4);
    }
  }
}

/// The largest difference between the energy of wheel and rotor and the work [J]. A base that does
/// not move leaves no error of the integrator.
double imbalance(ServoDescription servo, double h) {
  servo.backlash = 0.02;
  servo.coulomb = 0.05;
  Rig rig(servo);
  const double rotor = servo.rotor_inertia;
  double done = 0, worst = 0;
  for (long k = 0; k < std::lround(1.2 / h); ++k) {
    const double t = static_cast<double>(k) * h;
    const double load = t < 0.2 ? 1.0 : t < 0.4 ? -1.0 : 0.0;
    const StepReport& report = rig.step(t < 0.6 ? test::sine(2 * t) : 0.0, load, h);
    done += report.work.servos + report.work.joints + report.work.outside;
    const double dphi = report.motor_rate[0];
    const double energy = 0.5 * (kFlywheel * rig.rate() * rig.rate() + rotor * dphi * dphi);
    worst = std::max(worst, std::abs(energy - done));
  }
  return worst;
}

TEST(ServoBacklash, ItsEnergyBalanceCloses) {
  const ServoDescription servo = test::plain_servo();
  for (const double h : {1e-3, 5e-4, 2.5e-4}) EXPECT_LT(imbalance(servo, h), 1e-6) << h;
}

// A wheel that strikes the flanks of a motor at rest loses energy at every strike.
TEST(ServoBacklash, DoesNotBounceNorGainEnergy) {
  for (const double stiffness : {0.0, 5000.0, 1e6}) {
    ServoDescription servo = test::plain_servo();
    servo.backlash = 0.05;
    servo.gear_stiffness = stiffness;
    Rig rig(servo);
    RobotState start = rig.plant.state();
    start.dtheta[0] = 2;
    rig.plant.set_state(start);
    double energy = INFINITY;
    int reversals = 0;
    double rate = 2;
    for (int k = 0; k < 1000; ++k) {
      const StepReport& report = rig.step(0);
      const double phi = report.motor[0], dphi = report.motor_rate[0];
      const double gear = gear_stiffness(servo);
      const double press = std::max(0.0, std::abs(phi - rig.theta()) - 0.025);
      const double now = 0.5 * (kFlywheel * rig.rate() * rig.rate() + 0.01 * dphi * dphi +
                                60 * phi * phi + gear * press * press);
      EXPECT_LT(now, energy * (1 + 1e-12)) << k;
      energy = now;
      reversals += rig.rate() * rate < 0;
      if (rig.rate() != 0) rate = rig.rate();
    }
    EXPECT_LE(reversals, 3) << stiffness;
    EXPECT_LT(energy, 0.02 * 0.5 * 0.06 * 4);
  }
}

// The gear of a servo that has stiffness alone is a spring in series with the servo.
TEST(ServoGear, IsASpringInSeriesWithTheServo) {
  ServoDescription servo = test::plain_servo();
  servo.gear_stiffness = 120;
  Rig rig(servo);
  rig.rest(0.2, -3);
  EXPECT_NEAR(rig.theta(), 0.2 - 3.0 / 60 - 3.0 / 120, 1e-8);
  EXPECT_NEAR(rig.step(0.2, -3).torque[0], 3, 1e-6);
}

// On the way to a far target, the torque falls with the speed along a straight line: from the stall
// torque at rest to 0 at the speed stall torque / back-EMF constant.
TEST(ServoVoltage, BoundsTheTorqueByALineOverTheSpeed) {
  ServoDescription servo{.kp = 1000, .kd = 1, .rotor_inertia = 0.01};
  servo.stall_torque = 2;
  servo.back_emf = 0.5;
  Rig rig(servo);
  for (int k = 0; k < 1500; ++k) {
    const double torque = rig.step(100).torque[0];
    ASSERT_NEAR(torque, 2 - 0.5 * rig.rate(), 1e-9);
  }
  EXPECT_NEAR(rig.rate(), 4, 1e-3);
  Rig held(servo);
  held.step(100, -2);  // the load holds it
  EXPECT_NEAR(held.step(100, -2).torque[0], 2, 1e-8);
}

// If a motor is driven beyond its no-load speed, its full voltage brakes: the line continues below
// 0, and beyond the peak torque.
TEST(ServoVoltage, BrakesBeyondTheNoLoadSpeed) {
  ServoDescription servo{.kp = 1000, .kd = 1, .rotor_inertia = 0.01};
  servo.stall_torque = 2;
  servo.back_emf = 0.5;
  for (const double peak : {0.0, 1.5}) {
    OneJoint joint = joint_with(servo);
    joint.peak = peak;
    for (const double sign : {1.0, -1.0}) {
      Rig rig(joint);
      for (int k = 0; k < 1500; ++k) rig.step(sign * 100, sign * 3);
      EXPECT_NEAR(rig.rate(), sign * 10, 0.01);  // the rate is (2 + 3) / 0.5
      EXPECT_NEAR(rig.step(sign * 100, sign * 3).torque[0], -sign * 3, 0.01);
    }
  }
}

// A joint within the dead band has no position error; a load pushes it to the edge and beyond.
TEST(ServoDeadBand, HoldsNothingWithinIt) {
  ServoDescription servo = test::plain_servo();
  servo.dead_band = 0.03;
  Rig inside(servo);
  inside.rest(0.029);
  EXPECT_EQ(inside.theta(), 0);
  Rig outside(servo);
  outside.rest(0.2);
  EXPECT_NEAR(outside.theta(), 0.2, 0.03);
  for (const double sign : {1.0, -1.0}) {
    outside.rest(0.2, sign * 1.2);
    EXPECT_NEAR(outside.theta(), 0.2 + sign * (0.03 + 1.2 / 60), 1e-6);
  }
}

// There are 2 counts per degree. Target and reading are rounded, so that a joint rests where its
// load makes a whole count flip.
TEST(ServoCounts, RoundTargetAndReading) {
  ServoDescription servo = test::plain_servo();
  servo.quantized = true;
  OneJoint joint = joint_with(servo);
  joint.counts = -2;
  const double count = M_PI / 180 / 2;
  Rig rig(joint);
  rig.rest(0.49 * count);
  EXPECT_EQ(rig.theta(), 0);
  // The torque of half a count, with one count of reading or none.
  rig.rest(7.4 * count, 0.5 * 60 * count);
  EXPECT_GT(rig.theta(), 7.4 * count);
  EXPECT_LT(rig.theta(), 7.6 * count);
}

// The joint rests at the target plus the offset, which is where its encoder reads the target.
TEST(ServoOffset, IsWhereTheEncoderReadsTheTarget) {
  ServoDescription servo = test::plain_servo();
  servo.offset = 0.02;
  Rig rig(servo);
  rig.rest(0.1);
  EXPECT_NEAR(rig.theta(), 0.12, 1e-9);

  RobotDescription d = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1").description();
  d.servos["l_elbow"].offset = 0.02;
  d.servos["l_elbow"].backlash = 0.01;
  const RobotModel model(d);
  const int elbow = model.find_dof("l_elbow");
  Plant plant(model, model.limits(), World{});
  RobotState start = model.rest_state();
  start.base.position.z() += 1;
  plant.set_state(start);
  Sensors sensors(model, model.limits(), kHold, false, 1);
  for (int k = 0; k < 400; ++k) {
    const StepReport& report = plant.step(start.theta, {}, kHold);
    const Measurement& m = sensors.read(plant.state(), plant.data(), report);
    EXPECT_EQ(m.theta[elbow], report.motor[elbow] - 0.02);
  }
  const double joint_at = plant.state().theta[elbow] - start.theta[elbow];
  EXPECT_NEAR(plant.step(start.theta, {}, kHold).motor[elbow] - start.theta[elbow], 0.02, 1e-3);
  EXPECT_NEAR(joint_at, 0.02, 0.005 + 1e-3);  // the joint may be anywhere in the play
}

// Pushing into the servo's own stop loads its gear: the end stop is part of the external load.
TEST(ServoFriction, CountsTheEndStopAsLoad) {
  ServoDescription servo{.kp = 20, .kd = 2, .rotor_inertia = 0.01, .coulomb = 0.1};
  servo.load.external = 0.2;
  RobotDescription d = test::model_of(joint_with(servo)).description();
  d.joints[0].type = JointType::revolute;
  d.joints[0].has_limits = true;
  d.joints[0].lower = -1;
  d.joints[0].upper = 0.1;
  const RobotModel model(d);
  Plant plant(model, model.limits(), World{});
  RobotState start = model.rest_state();
  start.base.position.z() = 1000;
  plant.set_state(start);
  const auto rest = [&](double target) {
    double torque = 0;
    for (int k = 0; k < 3000; ++k)
      torque = plant.step(VectorXd::Constant(1, target), {}, kHold).torque[0];
    return torque;
  };
  const double torque = rest(0.6);  // it pushes into the stop, which gives way by 1/20 of its error
  const double press = 20 * 20 * (plant.state().theta[0] - 0.1);
  // At rest, the friction holds any torque up to its bound, and the joint came to rest while it
  // slid in.
  const double friction = std::abs(torque - press);
  EXPECT_LE(friction, 0.1 + 0.2 * press + 1e-9);
  EXPECT_GT(friction, 3 * 0.1);
}

}  // namespace
}  // namespace ayumi
