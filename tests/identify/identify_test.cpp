// The constants of servos from recordings. The synthetic servos are simulated by other means than
// those of the estimator (synthetic_servo.hpp).

#include "ayumi/identify/identify.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/identify/recording_checks.hpp"
#include "ayumi/identify/servo_response.hpp"
#include "tests/identify/synthetic_servo.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi::test {
namespace {

constexpr double kNoise = 2e-4, kCount = 8.35e-5;  // [rad]: 0.011 deg, 209 counts per degree

IdentifyOptions held_root() {
  IdentifyOptions options;
  options.stand = RobotStand::fixed;
  options.threads = 1;
  return options;
}

IdentifiedJoint found(const SyntheticServo& servo, const Eigen::VectorXd& theta,
                      std::uint64_t seed) {
  const RobotModel model(pendulum_robot(servo));
  return identify(model, recorded(theta, kNoise, kCount, seed, excitation), held_root(), "m.csv")
      .joints.at(0);
}

bool covers(const ServoEstimate& estimate, double truth) {
  return estimate.lower <= truth && truth <= estimate.upper;
}

struct Truth {
  const char* name;
  SyntheticServo servo;
};
SyntheticServo soft() { return {}; }
SyntheticServo stiff() {
  SyntheticServo servo;
  servo.kp = 3000;
  servo.kd = 4;
  servo.viscous = 2;
  servo.coulomb = 0.5;
  servo.delay = 0.0021;
  return servo;
}

// Seven servos are simulated side by side and one after the other.
TEST(ServoResponse, SeveralServosGiveTheNumbersOfEach) {
  constexpr Eigen::Index kRows = 400;
  JointRecording joint;
  joint.command.resize(kRows);
  for (Eigen::Index k = 0; k < kRows; ++k) joint.command[k] = 0.3 * std::sin(0.02 * double(k));
  joint.measured = joint.command;
  joint.torque = 2 * joint.command;
  joint.inertia = Eigen::VectorXd::Constant(kRows, 0.02);
  joint.link_inertia = Eigen::VectorXd::Constant(kRows, 0.005);
  joint.acceleration = -400 * joint.command;
  joint.rate = Eigen::VectorXd::Zero(kRows);
  for (Eigen::Index k = 0; k < kRows; k += 3) joint.compared.push_back(k);
  std::vector<ServoConstants> servos(7, {0.004, 1e-3, 2e-3, 1e-3, 2e-3, 1e-3});
  servos[1].delay = 0.006;
  servos[2].compliance = 2e-3;
  servos[3].damping = 4e-3;
  servos[4].dry = 4e-3;
  servos[5].backlash = 0;
  servos[6].offset = -2e-3;
  for (const bool at_once : {false, true})
    for (const CommandLaw law : {CommandLaw::linear, CommandLaw::held, CommandLaw::stepped}) {
      joint.at_once = at_once;
      joint.law = law;
      Eigen::MatrixXd together, alone;
      servo_responses(joint, servos, together);
      ASSERT_EQ(together.cols(), 7);
      for (Eigen::Index i = 0; i < 7; ++i) {
        servo_responses(joint, {servos[static_cast<size_t>(i)]}, alone);
        EXPECT_EQ(together.col(i), alone.col(0)) << i;
        if (i > 0 && !at_once) {  // this leaves the damping out
          EXPECT_NE(together.col(i), together.col(0)) << i;
        }
      }
    }
}

// Six seconds with noise and counts: the delay is found to half a millisecond, the others to 10 %.
TEST(Identify, FindsTheConstantsOfASyntheticServo) {
  for (const SyntheticServo& servo : {soft(), stiff()}) {
    const Eigen::VectorXd theta = simulated_angles(servo, 6, excitation);
    const IdentifiedJoint joint = found(servo, theta, 7);
    EXPECT_NEAR(joint.delay.value, servo.delay, 0.0005);
    EXPECT_NEAR(joint.kp.value, servo.kp, 0.1 * servo.kp);
    EXPECT_NEAR(joint.viscous.value, servo.viscous, 0.1 * servo.viscous);
    EXPECT_NEAR(joint.coulomb.value, servo.coulomb, 0.1 * servo.coulomb);
    EXPECT_NEAR(joint.offset.value, servo.offset, 2e-4);
    EXPECT_TRUE(joint.kp.known && joint.viscous.known && joint.coulomb.known);
    EXPECT_TRUE(joint.confounded.empty());
  }
}

// The intervals are those of 95 %: of a hundred noises, at most seven may give an interval without
// the true value. This holds for a servo that moves gradually from one command to the next, and for
// a servo that holds each command until the next one.
TEST(IdentifyIntervals, CoverTheTruth) {
  const auto held = [](double t) { return excitation(0.001 * std::floor(1000 * t + 1e-6)); };
  for (const bool holds : {false, true}) {
    const SyntheticServo servo = soft();
    const Eigen::VectorXd theta =
        holds ? simulated_angles(servo, 6, held) : simulated_angles(servo, 6, excitation);
    constexpr int kSeeds = 100;
    std::atomic<int> delay = 0, kp = 0, viscous = 0, coulomb = 0;
    std::atomic<bool> stop = false;
    in_parallel(kSeeds, 2, stop, [&](size_t i) {
      const IdentifiedJoint joint = found(servo, theta, 100 + i);
      EXPECT_NEAR(joint.delay.value, servo.delay, 0.0005);
      delay += covers(joint.delay, servo.delay);
      kp += covers(joint.kp, servo.kp);
      viscous += covers(joint.viscous, servo.viscous);
      coulomb += covers(joint.coulomb, servo.coulomb);
    });
    EXPECT_GE(delay, 93) << holds;
    EXPECT_GE(kp, 93) << holds;
    EXPECT_GE(viscous, 93) << holds;
    EXPECT_GE(coulomb, 93) << holds;
  }
}

// There is neither a load that changes nor a quick motion: constants that cannot be distinguished
// are named.
TEST(Identify, NamesWhatItCannotTellApart) {
  const SyntheticServo servo = stiff();
  const auto slow = [](double t) { return 0.05 * std::sin(2 * M_PI * 0.4 * t); };
  const Eigen::VectorXd theta = simulated_angles(servo, 6, slow);
  const RobotModel model(pendulum_robot(servo));
  const IdentifiedJoint joint =
      identify(model, recorded(theta, kNoise, kCount, 1, slow), held_root(), "m.csv").joints.at(0);
  ASSERT_FALSE(joint.confounded.empty());
  EXPECT_NE(joint.confounded[0].find("delay and damping cannot be distinguished"),
            std::string::npos)
      << joint.confounded[0];
  const double lag = servo.delay + (servo.kd + servo.viscous) / servo.kp;
  EXPECT_NEAR(joint.lag.value, lag, 0.001);
  EXPECT_TRUE(covers(joint.lag, lag)) << joint.lag.lower << " to " << joint.lag.upper;
  // The delay alone is not known, and its interval says so.
  ASSERT_TRUE(joint.delay_is_lag);
  EXPECT_FALSE(joint.delay.known);
  EXPECT_TRUE(covers(joint.delay, servo.delay));
}

TEST(Identify, TheSameForAnyNumberOfThreads) {
  const SyntheticServo servo = soft();
  const Eigen::VectorXd theta = simulated_angles(servo, 3, excitation);
  const RobotModel model(pendulum_robot(servo));
  const RecordedMotion motion = recorded(theta, kNoise, kCount, 3, excitation);
  IdentifyOptions options = held_root();
  const IdentifiedJoint one = identify(model, motion, options, "m").joints.at(0);
  options.threads = 4;
  const IdentifiedJoint four = identify(model, motion, options, "m").joints.at(0);
  EXPECT_EQ(one.kp.value, four.kp.value);
  EXPECT_EQ(one.delay.upper, four.delay.upper);
}

// If the angles are behind the command by clearly more than the lag in the robot's file
// (kLikelyShift), there is a caution. If they are behind by more than longest_lag, the recording is
// refused.
TEST(Identify, SaysThatTheRecordingMayBeShifted) {
  const SyntheticServo servo = soft();
  const Eigen::VectorXd theta = simulated_angles(servo, 6, excitation);
  const RobotModel model(pendulum_robot(servo));
  RecordedMotion motion = recorded(theta, kNoise, kCount, 1, excitation);
  EXPECT_EQ(identify(model, motion, held_root(), "m.csv").caution, "");
  const Eigen::MatrixXd old = motion.measured.theta;
  constexpr Eigen::Index kLate = 15;
  motion.measured.theta.topRows(kLate).setConstant(old(0, 0));
  motion.measured.theta.bottomRows(old.rows() - kLate) = old.topRows(old.rows() - kLate);
  EXPECT_NE(identify(model, motion, held_root(), "m.csv")
                .caution.find("ms. Make sure that both files begin at the same time"),
            std::string::npos);
  IdentifyOptions strict = held_root();
  strict.longest_lag = 0.01;
  EXPECT_THROW(identify(model, motion, strict, "m.csv"), Error);
  for (const double lag : {-1.0, 0.0005, 1e300, std::nan("")}) {
    strict.longest_lag = lag;
    EXPECT_EQ(
        error_message([&] { identify(model, motion, strict, "m.csv"); }, ErrorCode::usage),
        "the longest lag of a servo is " + text::exact(lag) + " s; it must be from 0.001 to 0.5 s");
  }
}

// Angles that are two rows ahead of their command are accepted, because some recorders number their
// rows so, but no servo answers before its command.
TEST(Identify, SaysThatAnglesAreAheadOfTheirCommand) {
  const SyntheticServo servo = soft();
  const Eigen::VectorXd theta = simulated_angles(servo, 6, excitation);
  const RobotModel model(pendulum_robot(servo));
  RecordedMotion motion = recorded(theta, kNoise, kCount, 1, excitation);
  const Eigen::MatrixXd old = motion.measured.theta;
  const double lag = time_shift(model, motion.command, motion.measured, 0);
  const Eigen::Index early = std::lround(lag / motion.measured.dt) + 2;
  motion.measured.theta.topRows(old.rows() - early) = old.bottomRows(old.rows() - early);
  motion.measured.theta.bottomRows(early).rowwise() = old.bottomRows<1>();
  EXPECT_NE(identify(model, motion, held_root(), "m.csv").caution.find("ms ahead of their command"),
            std::string::npos);
}

std::string answer_error(const std::function<void(RecordedMotion&)>& spoil) {
  const SyntheticServo servo = soft();
  static const Eigen::VectorXd theta = simulated_angles(soft(), 6, excitation);
  const RobotModel model(pendulum_robot(servo));
  RecordedMotion motion = recorded(theta, kNoise, kCount, 1, excitation);
  spoil(motion);
  try {
    require_answer(model, motion.command, motion.measured, 0.03, "m.csv");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "";
}

TEST(RecordingChecks, OneLineForARecordingThatIsNotTheAnswer) {
  const auto said = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const auto late_by = [](Eigen::Index rows) {
    return [rows](RecordedMotion& m) {
      const Eigen::MatrixXd old = m.measured.theta;
      m.measured.theta.topRows(rows).setConstant(old(0, 0));
      m.measured.theta.bottomRows(old.rows() - rows) = old.topRows(old.rows() - rows);
    };
  };
  EXPECT_EQ(answer_error([](RecordedMotion&) {}), "");
  said(answer_error([](RecordedMotion& m) { m.measured.theta.conservativeResize(3000, 1); }),
       "m.csv: the recording lasts 2.999 s, but its command lasts 6.000 s");
  said(answer_error(late_by(800)),
       "ms behind their command, but a servo is at most 30 ms behind its command. The recording is "
       "shifted in time");
  // A lag of 50 ms is also too large for a servo.
  said(answer_error(late_by(50)),
       "ms behind their command, but a servo is at most 30 ms behind its command. The recording is "
       "shifted in time");
  said(answer_error([](RecordedMotion& m) { m.measured.theta.conservativeResize(5901, 1); }),
       "m.csv: the recording lasts 5.900 s, but its command lasts 6.000 s");
  said(answer_error([](RecordedMotion& m) { m.measured.theta *= -1; }),
       "arm_joint moves against its command");
  said(answer_error([](RecordedMotion& m) { m.measured.theta *= 180 / M_PI; }),
       "one of the two files is in degrees");
  said(answer_error([](RecordedMotion& m) { m.measured.theta.setConstant(0.3); }),
       "arm_joint stays at");
  said(answer_error([](RecordedMotion& m) {
         for (Eigen::Index k = 0; k < m.measured.theta.rows(); ++k)
           m.measured.theta(k, 0) = 0.3 * std::sin(0.0047 * static_cast<double>(k));
       }),
       "arm_joint does not follow its command");
  said(answer_error([](RecordedMotion& m) { m.command.theta.setConstant(0.1); }),
       "the command of this recording moves no joint by 0.5 deg");
}

/// Two movements with 1.5 s of rest between them.
double moves_with_a_rest(double t) {
  const double moved = t < 4 ? t : t < 5.5 ? 4 : t - 1.5;
  return 0.35 * (1 - std::cos(2 * M_PI * moved / 2)) + 0.1 * std::sin(2 * M_PI * moved);
}

// Three rows are lost while nothing moves, and the recording has three more rows at its end
// instead. The delays before and after the gap show the loss. A recording without a lost row, and
// one with the times of its rows, are accepted.
TEST(RecordingChecks, RowsThatAreMissingInARest) {
  const SyntheticServo servo = soft();
  const RobotModel model(pendulum_robot(servo));
  RecordedMotion motion = recorded(simulated_angles(servo, 9.5, moves_with_a_rest), kNoise, kCount,
                                   1, moves_with_a_rest);
  const auto refusal = [&] {
    try {
      require_answer(model, motion.command, motion.measured, 0.03, "m.csv");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(), "");
  const Eigen::MatrixXd whole = motion.measured.theta;
  const Eigen::Index gap = 4700, missing = 3, rows = whole.rows();
  motion.measured.theta << whole.topRows(gap), whole.bottomRows(rows - gap - missing),
      whole.bottomRows(missing);
  EXPECT_NE(refusal().find("3 rows are missing"), std::string::npos) << refusal();
  motion.measured.theta = whole.topRows(rows - 2);
  EXPECT_NE(refusal().find("2 rows are missing, in a pause or at the end"), std::string::npos)
      << refusal();
  motion.measured.timed = true;
  EXPECT_EQ(refusal(), "");
}

TEST(RecordingChecks, OneLineForLoadCellsOfAnotherMotion) {
  AngleTable measured;
  measured.dt = 0.001;
  measured.theta = Eigen::MatrixXd::Zero(6001, 1);
  SensorTable loads;
  loads.dt = 0.002;
  loads.foot_load = Eigen::MatrixXd::Constant(3001, 2, 30);
  EXPECT_NO_THROW(require_loads(loads, measured, 0.97, "l.csv"));
  EXPECT_NO_THROW(require_loads({}, measured, 1, "l.csv"));
  const auto message = [&](double agreement) {
    return error_message([&] { require_loads(loads, measured, agreement, "l.csv"); },
                         ErrorCode::bad_file);
  };
  EXPECT_NE(message(0.6).find("l.csv: while one foot stands, its load cells carry only 60 %"),
            std::string::npos)
      << message(0.6);
  loads.foot_load.conservativeResize(1500, 2);
  EXPECT_NE(
      message(1).find("l.csv: the recording lasts 2.998 s, but the measured angles last 6.000 s"),
      std::string::npos)
      << message(1);
}

}  // namespace
}  // namespace ayumi::test
