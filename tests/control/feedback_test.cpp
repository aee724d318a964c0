// The equations of the feedback law, function by function, on a point mass.
#include "ayumi/control/feedback.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/pendulum.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using test::LevelPendulum;
using test::Motion;

CogError error_of(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
  return {position, velocity};
}

// This tests (21).
TEST(Feedback, ErrorIsCommandLessMeasured) {
  CommandSample command;
  command.cog = {0.30, -0.20, 0.25};
  command.dcog = {0.1, 0.2, -0.3};
  Estimate estimate;
  estimate.cog = {0.28, -0.21, 0.26};
  estimate.dcog = {0.4, 0.2, 0.1};
  const CogError error = cog_error(command, estimate);
  EXPECT_LT((error.position - Eigen::Vector3d(0.02, 0.01, -0.01)).norm(), 1e-15);
  EXPECT_LT((error.velocity - Eigen::Vector3d(-0.3, 0.0, -0.4)).norm(), 1e-15);
}

/// The distance of a pendulum from its command at 0 after `time` [s], if it starts at rest 10 mm
/// away, with the ZMP of (18).
double distance_after(double time, double K, double D) {
  const LevelPendulum pendulum;
  const double dt = 1e-4;
  Motion s = {0.010, 0};
  for (int k = 0; k < std::lround(time / dt); ++k)
    s = test::step(s, dt, [&](const Motion& m) {
      const CogError error = error_of({-m.x, 0, 0}, {-m.v, 0, 0});
      return pendulum.acceleration(m.x, long_term_zmp(Vector2d::Zero(), K, D, error).x());
    });
  return std::abs(s.x);
}

// (18)(19) need K > 1 and D > 0 with the corrected sign; D < 0 is the printed sign.
TEST(Feedback, LongTermBringsThePendulumBack) {
  const double D = 2 / LevelPendulum().omega();
  EXPECT_LT(distance_after(3, 2, D), 1e-6);
  EXPECT_GT(distance_after(0.6, 2, -D), 0.3);
  EXPECT_GT(distance_after(3, 0.9, D), 0.010);
}

// With the poles -omega and -q omega, only the divergent component is fed back.
TEST(Feedback, RegulatorIsTheLongTermLawWithChosenPoles) {
  const double q = 0.25, omega = LevelPendulum().omega();
  const Vector2d goal(0.02, -0.01);
  const Eigen::Vector3d cog(0.05, 0.03, 0.225), dcog(-0.1, 0.2, 0);
  const CogError error = error_of(Eigen::Vector3d(goal.x(), goal.y(), 0) - cog, -dcog);
  const Vector2d general = long_term_zmp(goal, 1 + q, (1 + q) / omega, error);
  const Vector2d dcm = divergent_component(cog, dcog, omega).head<2>();
  EXPECT_LT((regulating_zmp(goal, q, dcm) - general).norm(), 1e-15);
}

// If the servos of a robot follow, its real acceleration omega^2 (x - zmp) is that of the
// reference: zmp = (x + k ref) / (1 + k). The larger the gain k is, the nearer is (14) with ref
// ZMP.
TEST(Feedback, ShortTermTendsToEquation14) {
  const double omega2 = 44;
  const Vector2d cog(0.03, -0.02), ref(0.01, 0.02);
  double before = 1e9;
  for (const double gain : {0.5, 2.0, 1e2, 1e6}) {
    const Vector2d zmp = (cog + gain * ref) / (1 + gain);
    const Vector2d asked = short_term_acceleration(gain, omega2, zmp - ref);
    EXPECT_LT((asked - horizontal_acceleration(omega2, cog, zmp)).norm(), 1e-9);
    const double off = (asked - horizontal_acceleration(omega2, cog, ref)).norm();
    EXPECT_LT(off, before);
    before = off;
  }
  EXPECT_LT(before, 1e-5);
  EXPECT_EQ(short_term_acceleration(0, omega2, cog - ref), Vector2d(0, 0));
}

// The damping of rocking is proportional to the error up to a limit, which grows with the height
// and with omega^2; beyond it, only the direction of the error counts.
TEST(Feedback, RockingIsDampedUpToALimit) {
  const double gain = 0.4, omega = 6.5, z = 0.22;
  const Eigen::Vector3d reference(0.02, -0.01, 0.3);
  const auto asked = [&](const Vector2d& error, double height, double rate) {
    Estimate estimate;
    estimate.dcog = reference;
    estimate.dcog.head<2>() += error;
    estimate.dcog.z() = -1;
    return rocking_acceleration(gain, rate, height, reference, estimate);
  };
  const Vector2d error(3e-4, -4e-4);
  EXPECT_LT((asked(error, z, omega) - gain * omega * error).norm(), 1e-12);
  const Vector2d most = asked(1e5 * error, z, omega);
  EXPECT_LT((asked(2e5 * error, z, omega) - most).norm(), 1e-12);
  EXPECT_LT((most.normalized() - error.normalized()).norm(), 1e-12);
  EXPECT_NEAR(asked(1e5 * error, 2 * z, omega).norm(), 2 * most.norm(), 1e-12);
  EXPECT_NEAR(asked(1e5 * error, z, 2 * omega).norm(), 4 * most.norm(), 1e-12);
  // Just below the limit it is still proportional.
  const Vector2d below = 0.999 * most / (gain * omega);
  EXPECT_LT((asked(below, z, omega) - 0.999 * most).norm(), 1e-12);
}

// A ZMP that is wanted outside the support needs the whole support. So the damping must not move
// the ZMP back from the edge there; other directions are damped as before.
TEST(Feedback, DampingGivesWayToAZmpThatIsWantedOutside) {
  const double K = 1.25, omega = 6.5, z = 0.22, most = 0.09 * z * omega * omega;
  const auto left = [&](const Vector2d& missing, const Vector2d& rocking) {
    return without_part_against(missing, rocking, K, omega, z);
  };
  const Vector2d rocking(0.6 * most, 0.5 * most);
  EXPECT_EQ(left(Vector2d::Zero(), rocking), rocking);
  EXPECT_LT((left({z, 0}, rocking) - Vector2d(0, rocking.y())).norm(), 1e-12);
  EXPECT_EQ(left({-z, 0}, rocking), rocking);
  EXPECT_EQ(left({0.001, 0}, rocking), rocking) << "a small distance bounds only a larger damping";
  const double near = left({0.012, 0}, rocking).x(), far = left({0.016, 0}, rocking).x();
  EXPECT_GT(rocking.x(), near);
  EXPECT_GT(near, far);
  EXPECT_GT(far, 0);
}

// (20) with critical damping does not overshoot.
TEST(Feedback, LongTermForceBringsTheHeightBack) {
  const double mass = 6.5, omega = 6.6;
  Motion s = {-0.010, 0};
  double highest = s.x;
  for (int k = 0; k < 30000; ++k) {
    s = test::step(s, 1e-4, [&](const Motion& m) {
      const CogError error = error_of({0, 0, -m.x}, {0, 0, -m.v});
      return vertical_acceleration(
          long_term_force(mass * kGravity, mass, omega * omega, 2 * omega, error), mass);
    });
    highest = std::max(highest, s.x);
  }
  EXPECT_LT(std::abs(s.x), 1e-6);
  EXPECT_LT(highest, 1e-6);
}

/// The vertical motion of a point mass under (24) with this stiffness per mass, about z = 0.
Motion spring_step(const Motion& s, double stiffness, double mass) {
  return test::step(s, 1e-6, [&](const Motion& m) {
    const HeightGains gains = {mass * stiffness, 0};
    return vertical_acceleration(height_force(gains, mass * kGravity, 0, m.x, m.v), mass);
  });
}

// (26): after the release at the reference height, the speed carries the mass to z_H above it.
TEST(Feedback, PushReachesThePlannedApex) {
  const double z_H = 0.03, z_d = 0.04;
  Motion s = {-z_d, 0};
  while (s.x < 0) s = spring_step(s, push_stiffness(z_H, z_d), 6.5);
  EXPECT_NEAR(s.v * s.v / (2 * kGravity), z_H, 1e-6);
}

// This tests (27).
TEST(Feedback, LandingStoopsByThePlannedDepth) {
  const double speed = 0.8, z_d = 0.03;
  Motion s = {0, -speed};
  while (s.v < 0) s = spring_step(s, landing_stiffness(speed, z_d), 6.5);
  EXPECT_NEAR(s.x, -z_d, 1e-6);
}

}  // namespace
}  // namespace ayumi
