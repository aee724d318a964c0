// The largest acceleration of an unloaded motor, tau_max / J.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/check/consistency.hpp"
#include "tests/support/planted.hpp"

namespace ayumi::test {
namespace {

using namespace planted;

/// A walk of HOAP-1 in which one joint swings with this acceleration, as a sine of one period.
CommandSeries swung(const std::string& joint, double acceleration, double period) {
  CommandSeries series = sample(hoap1(), walk());
  const int dof = hoap1().find_dof(joint);
  const double w = 2 * M_PI / period, begin = 0.1;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = static_cast<double>(k) * series.dt - begin;
    if (t < 0 || t > period) continue;
    CommandSample& s = series.samples[k];
    s.state.theta[dof] -= acceleration / (w * w) * std::sin(w * t);
    s.state.dtheta[dof] -= acceleration / w * std::cos(w * t);
    s.acceleration[6 + dof] += acceleration * std::sin(w * t);
  }
  return series;
}

double peak_over_inertia(const RobotModel& model, const std::string& joint) {
  const int dof = model.find_dof(joint);
  return model.limits("").peak_torque[dof] / model.limits("").servo[dof].rotor_inertia;
}

TEST(MotorAcceleration, ItsFigureIsTheClosedForm) {
  const double most = peak_over_inertia(hoap1(), "l_elbow");
  EXPECT_NEAR(most, 3 / 0.003, 1e-9);  // as stated in the robot's file
  for (const double share : {0.25, 0.8}) {
    const ConsistencyReport r = check_consistency(hoap1(), swung("l_elbow", share * most, 0.02));
    EXPECT_NEAR(r.summary[FindingKind::motor_acceleration], share, 0.02 * share);
    for (const Finding& f : r.findings) EXPECT_NE(f.kind, FindingKind::motor_acceleration);
  }
}

TEST(MotorAcceleration, MoreThanTheMotorCanGiveIsFound) {
  const double most = peak_over_inertia(hoap1(), "l_elbow");
  const ConsistencyReport r = check_consistency(hoap1(), swung("l_elbow", 1.5 * most, 0.004));
  EXPECT_FALSE(r.consistent);
  const auto found = std::find_if(r.findings.begin(), r.findings.end(), [](const Finding& f) {
    return f.kind == FindingKind::motor_acceleration;
  });
  ASSERT_NE(found, r.findings.end());
  EXPECT_EQ(found->where, "l_elbow");
  EXPECT_EQ(dof_of(*found), hoap1().find_dof("l_elbow"));
  EXPECT_EQ(found->unit, "rad/s^2");
  EXPECT_NEAR(std::abs(found->worst), 1.5 * most, 0.05 * most);
  EXPECT_NEAR(found->limit, most, 1e-9);
  EXPECT_NEAR(found->at, 0.1, 0.005);
}

TEST(MotorAcceleration, ARobotWithoutRotorInertiaHasNone) {
  RobotDescription description = hoap1().description();
  for (auto& [joint, servo] : description.servos) servo.rotor_inertia = 0;
  const RobotModel model(description);
  const CommandSeries series = swung("l_elbow", 5000, 0.004);
  const ConsistencyReport r = check_consistency(model, series);
  EXPECT_EQ(r.summary[FindingKind::motor_acceleration], 0);
  for (const Finding& f : r.findings) EXPECT_NE(f.kind, FindingKind::motor_acceleration);
}

}  // namespace
}  // namespace ayumi::test
