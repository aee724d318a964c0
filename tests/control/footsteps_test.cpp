// Footholds, and the divergent component that they require, agree with the pendulum stepped in
// time.
#include "ayumi/control/footsteps.hpp"

#include <gtest/gtest.h>

#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;

TEST(Footsteps, ZmpToArriveTakesXiThere) {
  const double omega = 6.4, T = 0.3;
  const Vector2d dcm(0.012, -0.03), end(0.05, 0.02);
  const Vector2d zmp = zmp_to_arrive(dcm, end, std::exp(omega * T));
  Vector2d x = dcm;  // dcm' = omega (dcm - Z), integrated by small steps
  const int n = 200000;
  for (int i = 0; i < n; ++i) x += T / n * omega * (x - zmp);
  EXPECT_LT((x - end).norm(), 1e-6);
}

// A steady gait has b = L / (E - 1) along and W / (E + 1) across, towards the other foot.
TEST(Footsteps, LandingOffsetsOfASteadyWalk) {
  const double E = 11.5, L = 0.04, W = 0.078;
  std::vector<Vector2d> footholds;
  for (int k = 0; k < 14; ++k) footholds.emplace_back(k * L, k % 2 == 0 ? W / 2 : -W / 2);
  const Vector2d first = landing_offsets(footholds, E, Vector2d::Zero()).front();
  EXPECT_NEAR(first.x(), L / (E - 1), 1e-12);
  EXPECT_NEAR(first.y(), -W / (E + 1), 1e-12);
}

// Whatever the footholds are, a pendulum whose ZMP is on each of them in turn passes over all of
// them.
TEST(Footsteps, LandingOffsetsCarryThePendulumToTheEnd) {
  const double E = 9.0;
  const std::vector<Vector2d> footholds = {{0, 0.04}, {0.03, -0.05}, {0.08, 0.03}, {0.08, -0.04}};
  const Vector2d last(0, 0.04);
  const std::vector<Vector2d> b = landing_offsets(footholds, E, last);
  Vector2d dcm = footholds[0] + b[0];
  for (size_t k = 0; k + 1 < footholds.size(); ++k) {
    dcm = footholds[k] + E * (dcm - footholds[k]);
    EXPECT_LT((dcm - footholds[k + 1] - b[k + 1]).norm(), 1e-12) << k;
  }
  EXPECT_LT((dcm - footholds.back() - last).norm(), 1e-12);
}

struct Walker {
  RobotModel model = test::biped();
  std::array<Eigen::Isometry3d, 2> feet;
  double width = 0;
  Walker() {
    for (Side side : {Side::left, Side::right})
      feet[static_cast<int>(side)] =
          sole_frame(model, side, {{0, side == Side::left ? 0.05 : -0.05}, 0}, 0);
  }
};

TEST(Footsteps, SoleFrameAndGroundPoseAreInverse) {
  const Walker w;
  const GroundPose pose{{0.3, -0.2}, 0.7};
  const GroundPose back =
      ground_pose(w.model, Side::left, sole_frame(w.model, Side::left, pose, 0));
  EXPECT_LT((back.position - pose.position).norm(), 1e-14);
  EXPECT_NEAR(back.yaw, pose.yaw, 1e-14);
}

// Swings on the path of a turning walk are n - 1 steps of v T each, and the last one closes the
// feet.
TEST(Footsteps, PathOfATurningWalkEndsWithTheFeetTogether) {
  const Walker w;
  const double period = 0.4;
  StepGoal goal;
  goal.velocity = {0.1, 0};
  goal.turn = 0.3;
  Footsteps steps(w.model, w.feet, period, 10, 0.3);
  std::array<GroundPose, 2> feet;
  for (Side side : {Side::left, Side::right})
    feet[static_cast<int>(side)] = ground_pose(w.model, side, w.feet[static_cast<int>(side)]);
  Side stance = Side::left;
  for (int left = 6; left > 0; --left) {
    const GroundPose stands = feet[static_cast<int>(stance)];
    const PlannedStep step = steps.step(goal, stance, stands, left, Vector2d::Zero());
    steps.advance(goal, stance, left);
    stance = other(stance);
    feet[static_cast<int>(stance)] = step.landing;
  }
  const double turned = 5 * period * goal.turn;
  EXPECT_NEAR(feet[0].yaw, turned, 1e-12);
  EXPECT_NEAR(feet[1].yaw, turned, 1e-12);
  const Vector2d across = feet[0].position - feet[1].position;
  EXPECT_LT((across - Eigen::Rotation2Dd(turned) * Vector2d(0, 0.1)).norm(), 1e-12);
  // The path has five chords of v T, each turned by half a step more than the last heading.
  Vector2d middle = Vector2d::Zero();
  for (int i = 0; i < 5; ++i)
    middle += Eigen::Rotation2Dd((i + 0.5) * period * goal.turn) * Vector2d(0.04, 0);
  EXPECT_LT((0.5 * (feet[0].position + feet[1].position) - middle).norm(), 1e-12);
}

TEST(Footsteps, ErrorOfPlaceFadesByTheShareAsked) {
  const Walker w;
  Footsteps steps(w.model, w.feet, 0.4, 10, 0.3);
  GroundPose off = ground_pose(w.model, Side::left, w.feet[0]);
  off.position += Vector2d(0.01, 0.005);
  const PlannedStep step = steps.step({}, Side::left, off, 4, Vector2d::Zero());
  EXPECT_LT((step.landing.position - Vector2d(0.007, -0.05 + 0.0035)).norm(), 1e-12);
  // An error beyond the part that the steps correct moves the path instead.
  off.position.x() += 1;
  steps.meet(Side::left, off);
  const PlannedStep far = steps.step({}, Side::left, off, 4, Vector2d::Zero());
  EXPECT_LT((far.landing.position - off.position).norm(), 0.12);
}

}  // namespace
}  // namespace ayumi
