#include "ayumi/plan/foot_plan.hpp"

#include <gtest/gtest.h>

#include "ayumi/math/rotation.hpp"
#include "ayumi/plan/place_text.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

Pattern one_step() {
  Swing swing;
  swing.foot = Side::right;
  swing.to.position = {0.08, -0.04, 0.02};
  swing.to.rpy = {0, 0, 0.3};
  swing.lift = 0.03;
  Pattern pattern;
  pattern.phases = {
      {1.0, Support::both, {}}, {1.5, Support::left, swing}, {2.0, Support::both, {}}};
  return pattern;
}

TEST(FootPlan, StartsUnderTheDefaultPosture) {
  const RobotModel model = test::biped();
  const FootPlan plan(model, one_step());
  EXPECT_LT((plan.pose(Side::left, 0).translation() - Vector3d(0, 0.05, 0)).norm(), 1e-12);
  EXPECT_LT((plan.pose(Side::right, 0).translation() - Vector3d(0, -0.05, 0)).norm(), 1e-12);
  // The polygon's centre is 10 mm ahead of the sole frame.
  EXPECT_LT((plan.sole_center(Side::left, 0) - Vector3d(0.01, 0.05, 0)).norm(), 1e-12);
  EXPECT_LT((plan.support_center(0) - Vector3d(0.01, 0, 0)).norm(), 1e-12);
}

// A foot is held firmly while it carries, and least in the middle of the other foot's single
// support.
TEST(FootPlan, HoldsWhatCarries) {
  const FootPlan plan(test::biped(), one_step());
  const auto hold = [&](double t) { return plan.hold(Side::right, t); };
  for (const double t : {0.0, 0.999, 1.0, 1.5, 1.7}) EXPECT_EQ(hold(t), 1) << t;
  EXPECT_NEAR(hold(1.25), 0, 1e-12);
  EXPECT_EQ(plan.hold(Side::left, 1.25), 1);
  const double h = 1e-4;
  for (const double t : {1.0, 1.5}) {
    EXPECT_LT(std::abs(hold(t + h) - hold(t - h)) / (2 * h), 1e-4);
    EXPECT_LT(std::abs(hold(t + h) - 2 * hold(t) + hold(t - h)) / (h * h), 0.1);
  }
}

TEST(FootPlan, OneGivenFootPlacesTheOther) {
  Pattern pattern = one_step();
  Foothold left;
  left.position = {1, 2, 0};
  left.rpy = {0, 0, M_PI / 2};
  pattern.start_feet[0] = left;
  const FootPlan plan(test::biped(), pattern);
  EXPECT_LT((plan.pose(Side::right, 0).translation() - Vector3d(1.1, 2, 0)).norm(), 1e-12);
}

// A key with the numbers that a message or `inspect` states counts as a key at this place, also
// where the place has many digits.
TEST(FootPlan, APlaceInWordsIsExactEnoughForAKey) {
  EXPECT_EQ(place_text({0, -0.039, 0.1}), "[0, -0.039, 0.1]");
  EXPECT_EQ(place_text({-6.1e-6, -0.20285673, -1e-9}), "[-6e-06, -0.202857, 0]");
}

TEST(FootPlan, SwingsFromFootholdToFootholdAtRestAtBothEnds) {
  const FootPlan plan(test::biped(), one_step());
  const auto at = [&](double t) -> Vector3d { return plan.pose(Side::right, t).translation(); };
  EXPECT_EQ(at(0.3), at(1.0));
  EXPECT_LT((at(1.5) - Vector3d(0.08, -0.04, 0.02)).norm(), 1e-12);
  EXPECT_LT((at(1.25) - Vector3d(0.04, -0.045, 0.01 + 0.03)).norm(), 1e-12);
  EXPECT_LT((plan.pose(Side::right, 1.25).linear() - rpy_to_matrix({0, 0, 0.15})).norm(), 1e-12);
  const double h = 1e-4;
  for (const double t : {1.0, 1.5}) {
    EXPECT_LT(((at(t + h) - at(t - h)) / (2 * h)).norm(), 1e-4);
    EXPECT_LT(((at(t + h) - 2 * at(t) + at(t - h)) / (h * h)).norm(), 0.15);
  }
  EXPECT_NEAR(plan.ground(1.25), 0.5 * 0.01, 1e-12);
  EXPECT_EQ(plan.pose(Side::left, 1.3).translation(), plan.pose(Side::left, 0).translation());
}

TEST(FootPlan, PhasesTakeOverAtTheirEnd) {
  const FootPlan plan(test::biped(), one_step());
  EXPECT_EQ(plan.support(0), Support::both);
  EXPECT_EQ(plan.support(0.999), Support::both);
  EXPECT_EQ(plan.support(1.0), Support::left);
  EXPECT_EQ(plan.support(1.5), Support::both);
  EXPECT_EQ(plan.phase(7), 2);
  EXPECT_EQ(plan.duration(), 2.0);
}

TEST(FootPlan, FootKeysMoveAFreeFoot) {
  Pattern pattern = one_step();
  pattern.phases[1].swing.reset();
  const auto key = [&](double t, const Vector3d& position) {
    Keyframe k;
    k.t = t;
    k.feet[1] = Foothold{position, Vector3d::Zero()};
    pattern.keyframes.push_back(k);
  };
  key(1.0, {0, -0.05, 0});
  key(1.25, {0.02, -0.05, 0.03});
  key(1.5, {0.04, -0.05, 0});
  const FootPlan plan(test::biped(), pattern);
  EXPECT_LT((plan.pose(Side::right, 0.5).translation() - Vector3d(0, -0.05, 0)).norm(), 1e-12);
  EXPECT_LT((plan.pose(Side::right, 1.25).translation() - Vector3d(0.02, -0.05, 0.03)).norm(),
            1e-12);
  EXPECT_LT((plan.pose(Side::right, 1.9).translation() - Vector3d(0.04, -0.05, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace ayumi
