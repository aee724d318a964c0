// The inertial unit's own estimate of its tilt, compared with closed forms of its two-pole filter,
// and on a walking robot.

#include "ayumi/sim/tilt_estimate.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/sensors.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kTick = 1e-3;
const Vector3d kUp(0, 0, kGravity);

/// The rotation of an estimate against the unit's true attitude, in world axes [rad].
Vector3d error(const TiltEstimate& tilt, const Quaterniond& truth) {
  return log_rotation(tilt.attitude() * truth.conjugate());
}

// Both poles are at -1/(2T): an error e0 without bias falls as e0 (1 - t/2T) exp(-t/2T).
TEST(TiltEstimate, ForgetsAWrongStartAsItsPolesSay) {
  TiltEstimate tilt;
  tilt.start(exp_rotation({0.02, -0.01, 0}), Vector3d::Zero());
  for (int i = 1; i <= 12000; ++i) {
    tilt.update(Vector3d::Zero(), kUp, kTick);
    const double s = i * kTick / (2 * kTiltTime);
    const Vector3d expected = (1 - s) * std::exp(-s) * Vector3d(0.02, -0.01, 0);
    ASSERT_LT((error(tilt, Quaterniond::Identity()) - expected).norm(), 2e-5) << i;
  }
}

// An acceleration a sin(wt) tilts the apparent vertical by a/g; gravity corrects by 1/T of that, so
// that a/(g w T) remains.
TEST(TiltEstimate, SwayTiltsItByLittle) {
  const double a = 1.3, w = 2 * M_PI * 0.7;
  TiltEstimate tilt;
  tilt.start(Quaterniond::Identity(), Vector3d::Zero());
  double largest = 0;
  for (int i = 1; i <= 40000; ++i) {
    tilt.update(Vector3d::Zero(), kUp + Vector3d(0, a * std::cos(w * i * kTick), 0), kTick);
    if (i > 30000)
      largest = std::max(largest, error(tilt, Quaterniond::Identity()).head<2>().norm());
  }
  EXPECT_NEAR(largest, a / (kGravity * w * kTiltTime), 3e-4);
}

TEST(TiltEstimate, FollowsTurnsByTheGyro) {
  TiltEstimate tilt;
  Quaterniond truth = exp_rotation({0.1, 0.2, 0.3});
  tilt.start(truth, Vector3d::Zero());
  double largest = 0;
  for (int i = 1; i <= 3000; ++i) {
    const auto rate = [](double t) {
      return Vector3d(2 * std::cos(9 * t), 1.5 * std::sin(7 * t), 0.4 * std::cos(3 * t));
    };
    truth = truth * exp_rotation(kTick * rate((i - 0.5) * kTick));
    tilt.update(rate(i * kTick), truth.conjugate() * kUp, kTick);
    largest = std::max(largest, error(tilt, truth).norm());
  }
  EXPECT_LT(largest, 1.5e-3);  // the first step knows only one end of its rate
}

// A bias of the gyro that comes later tilts the estimate by at most b 2T/e, and is then
// compensated.
TEST(TiltEstimate, FindsABiasOfTheGyro) {
  const Vector3d bias(0.004, 0, 0);
  TiltEstimate tilt;
  tilt.start(Quaterniond::Identity(), Vector3d(0.01, 0, 0));
  double largest = 0;
  for (int i = 0; i < 100000; ++i) {
    tilt.update(Vector3d(0.01, 0, 0) + bias, kUp, kTick);
    largest = std::max(largest, error(tilt, Quaterniond::Identity()).norm());
  }
  EXPECT_NEAR(largest, bias.x() * 2 * kTiltTime / std::exp(1), 1e-4);
  EXPECT_LT(error(tilt, Quaterniond::Identity()).norm(), 1e-4);
  EXPECT_NEAR(tilt.gyro_bias().x(), 0.014, 1e-5);
}

TEST(TiltEstimate, FlightCorrectsNothing) {
  TiltEstimate tilt;
  const Quaterniond start = exp_rotation({0.02, 0, 0});
  tilt.start(start, Vector3d::Zero());
  for (int i = 0; i < 300; ++i) tilt.update(Vector3d::Zero(), Vector3d::Zero(), kTick);
  EXPECT_LT(error(tilt, start).norm(), 1e-15);
}

// The unit is away from the axis about which its link turns: the acceleration there is part of its
// reading.
TEST(TiltEstimate, SensorsGiveItTheForceWhereTheUnitIs) {
  RobotDescription description = test::biped_description();
  SensorDescription& s = description.sensors;
  s.imu_position = {0.02, 0.01, 0.1};
  s.accelerometer_noise = 1e-12;
  const RobotModel model(description);
  Sensors sensors(model, model.limits(), kTick, true, 0);
  RobotData data(model);
  RobotState state = model.rest_state();
  StepReport report;
  for (int side = 0; side < 2; ++side)
    report.soles[side].resize(model.sole(static_cast<Side>(side)).polygon.size());
  // The base sways about a line 0.3 m below it, once every 0.8 s.
  const double w = 2 * M_PI / 0.8, lean = 0.05;
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i * kTick, a = lean * (1 - std::cos(w * t)), rate = lean * w * std::sin(w * t);
    state.base.attitude = exp_rotation({a, 0, 0});
    state.base.position = state.base.attitude * Vector3d(0, 0, 0.3);
    state.base_angular_velocity = {rate, 0, 0};
    state.base_velocity = state.base_angular_velocity.cross(state.base.position);
    update_velocities(model, state, data);
    const Measurement& m = sensors.read(state, data, report);
    largest = std::max(largest, log_rotation(m.attitude * state.base.attitude.conjugate()).norm());
  }
  // In addition, apparent gravity turns by up to lean w^2 0.4 m / g = 0.126 rad.
  EXPECT_LT(largest, 1.3 * 0.126 / (w * kTiltTime) + 1e-3);
  EXPECT_GT(largest, 1e-4);
}

}  // namespace
}  // namespace ayumi
