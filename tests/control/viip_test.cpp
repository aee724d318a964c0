#include "ayumi/control/laws/viip.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

// Largest overshoot of a point mass brought up by 20 mm under (24) [m].
double overshoot(const ViipParams& params, double mass) {
  const double omega = 6.4, dt = 1e-5;
  double z = 0.205, dz = 0, over = 0;
  for (int i = 0; i < 300000; ++i) {
    dz += dt * (viip_force(params, mass, omega, 0.225, z, dz) / mass - kGravity);
    z += dt * dz;
    over = std::max(over, z - 0.225);
  }
  return over;
}

TEST(Viip, CorrectedCondition25DoesNotOvershoot) {
  for (const double mass : {1.0, 6.5, 35.0}) {
    ViipParams params;  // K_Dz^2 = 4 m K_Pz
    EXPECT_LE(overshoot(params, mass), 0.0002) << mass;
    params.height_damping = 1.5;
    EXPECT_LE(overshoot(params, mass), 0.0002) << mass;
  }
}

// (25) as printed, K_Dz^2 = 4 K_Pz, is dz = 1 / sqrt(m): right for a mass of 1 kg only.
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
  EXPECT_NE(complaint("single", 0).find("single must be positive"), std::string::npos);
  EXPECT_NE(complaint("hold", 2).find("hold must be at most 1"), std::string::npos);
  EXPECT_NE(complaint("ka", -1).find("not negative"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
