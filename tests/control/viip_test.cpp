#include "ayumi/control/laws/viip.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

// The largest overshoot of a point mass that is raised by 20 mm under (24) [m].
double overshoot(const ViipParams& params, double mass) {
  const double omega = 6.4, dt = 1e-5;
  double z = 0.205, dz = 0, over = 0;
  for (int i = 0; i < 300000; ++i) {
    const HeightGains gains = viip_height_gains(params, mass, omega);
    dz += dt * (viip_force(gains, mass, 0.225, z, dz) / mass - kGravity);
    z += dt * dz;
    over = std::max(over, z - 0.225);
  }
  return over;
}

TEST(Viip, CorrectedCondition25DoesNotOvershoot) {
  for (const double mass : {1.0, 6.5, 35.0}) {
    ViipParams params;  // here K_Dz^2 = 4 m K_Pz
    EXPECT_LE(overshoot(params, mass), 0.0002) << mass;
    params.height_damping = 1.5;
    EXPECT_LE(overshoot(params, mass), 0.0002) << mass;
  }
}

// (25) as printed, K_Dz^2 = 4 K_Pz, is dz = 1 / sqrt(m), which is only right for a mass of 1 kg.
TEST(Viip, PrintedCondition25Overshoots) {
  const auto printed = [](double mass) {
    ViipParams params;
    params.height_damping = 1 / std::sqrt(mass);
    return overshoot(params, mass);
  };
  EXPECT_LE(printed(1.0), 0.0002);
  EXPECT_NEAR(printed(6.5), 0.0052, 0.0003);
  EXPECT_NEAR(printed(35.0), 0.0117, 0.0003);
}

// K_Pz and K_Dz follow the contact, and (25) holds with each of them.
TEST(Viip, TheSpringDependsOnTheFeetThatBear) {
  const double mass = 6.5, omega = 6.4;
  const ViipParams params;
  const HeightGains both = viip_height_gains(params, mass, omega),
                    one = viip_height_gains(params, mass, omega, 1);
  EXPECT_NEAR(both.stiffness, mass * elementary::power<2>(1.5 * omega), 1e-9);
  EXPECT_NEAR(one.stiffness, mass * elementary::power<2>(params.one_foot_rate * omega), 1e-9);
  for (const HeightGains& gains : {both, one})
    EXPECT_NEAR(gains.damping * gains.damping, 4 * mass * gains.stiffness, 1e-6);
}

// A ring of mass m is turned about its centre, the COG, by the ground alone: with the acceleration
// of turning_acceleration() the ZMP stays under the COG.
TEST(Viip, ATurningBodyKeepsItsZmp) {
  const double mass = 6.5, z = 0.22, weight = mass * kGravity;
  const Eigen::Vector3d rate(0.3, -0.2, 0);  // rate of change L' [N m]
  const Eigen::Vector2d a = turning_acceleration(rate, mass, z);
  // The moment of the ground about the COG is (zmp - cog) x f = L'.
  const Eigen::Vector3d force(mass * a.x(), mass * a.y(), weight), arm(0, 0, -z);
  EXPECT_NEAR((arm.cross(force) - rate).norm(), 0, 1e-12);
}

std::string complaint(const std::string& gain, double value) {
  ControllerSpec spec;
  spec.type = ControllerKind::viip;
  spec.gains = {{gain, value}};
  try {
    viip_params(test::biped(), spec);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Viip, GainsAreChecked) {
  EXPECT_NE(complaint("dz", 0.9).find("K_Dz^2 >= 4 m K_Pz"), std::string::npos);
  EXPECT_NE(complaint("kaa", 1).find("did you mean 'ka'?"), std::string::npos);
  EXPECT_NE(complaint("single", 0).find("single is 0; it must be above 0"), std::string::npos);
  EXPECT_NE(complaint("hold", 2).find("hold is 2; it must be from 0 to 1"), std::string::npos);
  EXPECT_NE(complaint("ka", -1).find("must be from 0 to 1e+06"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
