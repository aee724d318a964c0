// Closed forms that follow from the paper's laws for a point mass.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/pendulum.hpp"

namespace ayumi {
namespace {

using test::LevelPendulum;
using test::Motion;

/// Whether a pendulum at rest over the middle of a support of half length `edge` comes back after
/// an impulse [N s], with a ZMP that feeds back dcm = x + v/omega and saturates at the edges.
bool survives(const LevelPendulum& pendulum, double edge, double impulse) {
  const double omega = pendulum.omega(), q = 0.25;
  Motion s = {0, impulse / pendulum.mass};
  for (int k = 0; k < 30000; ++k) {
    s = test::step(s, 2e-4, [&](const Motion& m) {
      const double zmp = (1 + q) * (m.x + m.v / omega);
      return pendulum.acceleration(m.x, std::clamp(zmp, -edge, edge));
    });
    if (std::abs(s.x) > 1) return false;
  }
  return std::abs(s.x) < 1e-3;
}

TEST(ClosedForms, CaptureBoundOfAStandingRobot) {
  const LevelPendulum pendulum;
  const double edge = 0.049;
  const double bound = pendulum.mass * pendulum.omega() * edge;
  EXPECT_NEAR(bound, 2.10, 0.01);
  EXPECT_TRUE(survives(pendulum, edge, 0.99 * bound));
  EXPECT_FALSE(survives(pendulum, edge, 1.01 * bound));
}

struct Leap {
  double release = 0;  ///< height of lift-off above the reference [m]
  double apex = 0;     ///< height of the apex above the reference [m]
};

/// (24) with the gains of (26) and gravity compensated, from rest at the depth of the stoop. The
/// mass lifts off at the reference height, or where the spring no longer pushes.
Leap leap(double mass, double apex_height, double stoop_depth, bool until_no_force) {
  const double kp = 2 * mass * kGravity * apex_height / (stoop_depth * stoop_depth);
  auto fz = [&](double z) { return -kp * z + mass * kGravity; };
  Motion s = {-stoop_depth, 0};
  while (until_no_force ? fz(s.x) > 0 : s.x < 0)
    s = test::step(s, 1e-6, [&](const Motion& m) { return vertical_acceleration(fz(m.x), mass); });
  return {s.x, s.x + s.v * s.v / (2 * kGravity)};
}

TEST(ClosedForms, JumpOfEquation26) {
  const double mass = 6.5, depth = 0.04;
  for (double height : {0.03, 0.04, 0.05}) {
    EXPECT_NEAR(leap(mass, height, depth, false).apex, height, 1e-6);
    const Leap spring = leap(mass, height, depth, true);
    EXPECT_NEAR(spring.release, depth * depth / (2 * height), 1e-6);
    EXPECT_NEAR(spring.apex, height + depth * depth / (4 * height), 1e-6);
  }
}

TEST(ClosedForms, TouchdownOfEquation27StoopsByThePlannedDepth) {
  const double mass = 6.5, depth = 0.03, speed = 0.8;
  const double kp = mass * speed * speed / (depth * depth);
  Motion s = {0, -speed};
  while (s.v < 0)
    s = test::step(s, 1e-6, [&](const Motion& m) {
      const double fz = -kp * m.x + mass * kGravity;
      return vertical_acceleration(fz, mass);
    });
  EXPECT_NEAR(s.x, -depth, 1e-6);
}

}  // namespace
}  // namespace ayumi
