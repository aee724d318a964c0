// Ground that is more than a plane, and ground that moves: closed forms with blocks, and HOAP-1's
// soles.

#include "tests/support/ground.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/ground.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/schedule.hpp"
#include "tests/support/block.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::kStep;

GroundBlock step_at(const Vector2d& low, const Vector2d& high, double height) {
  GroundBlock block;
  block.low = low;
  block.high = high;
  block.height = height;
  return block;
}

struct BlockIn {
  BlockIn(const World& world, const Vector3d& place, const Vector3d& size = {0.2, 0.1, 0.04})
      : model(test::block_description(size, 2.0)), plant(model, model.limits(), world) {
    RobotState s = model.rest_state();
    s.base.position = place;
    plant.set_state(s);
  }
  void run(double time, const StepInput& input = {}) {
    for (long i = 0; i < std::lround(time / kStep); ++i) plant.step(VectorXd(0), input, kStep);
  }
  const Vector3d& position() const { return plant.state().base.position; }
  RobotModel model;
  Plant plant;
};

TEST(Ground, BlocksRestOnStepsAndOnThePlaneBelow) {
  World world;
  world.height = -0.01;
  world.blocks.push_back(step_at({-0.5, -0.5}, {0.5, 0.5}, 0.05));
  BlockIn above(world, {0, 0, 0.08}), beside(world, {0, 1, 0.03});
  above.run(0.5);
  beside.run(0.5);
  EXPECT_NEAR(above.position().z(), 0.07, 1e-6);
  EXPECT_NEAR(beside.position().z(), 0.01, 1e-6);
}

// A sole does not touch tiles that lie under other tiles, and too many edges under a sole are
// refused instead of taking hours.
TEST(Ground, WhatAHigherBlockCoversIsNoContactAndTooManyEdgesAreRefused) {
  const std::vector<Vector3d> sole = {
      {-0.05, -0.03, 0.0205}, {0.05, -0.03, 0.0205}, {0.05, 0.03, 0.0205}, {-0.05, 0.03, 0.0205}};
  const auto inner = [&](const World& world) {
    std::vector<InnerPoint> points;
    Ground(world).inner_points(sole, 0.003, points);
    return points.size();
  };
  World world;
  world.blocks.push_back(step_at({-0.02, -0.01}, {0.02, 0.01}, 0.02));
  EXPECT_EQ(inner(world), 4u);
  for (int i = 1; i < 60; ++i)
    world.blocks.push_back(step_at({-0.02 + 1e-4 * i, -0.01 + 1e-4 * i},
                                   {0.02 - 1e-4 * i, 0.01 - 1e-4 * i}, 0.02 - 1e-5 * i));
  EXPECT_EQ(inner(world), 4u);
  World tiles;
  for (int i = 0; i < 100; ++i) {
    const Vector2d low(-0.048 + 0.009 * (i % 10), -0.028 + 0.005 * (i / 10));
    tiles.blocks.push_back(step_at(low, low + Vector2d(0.004, 0.002), 0.02));
  }
  const std::string refusal = test::error_message([&] { inner(tiles); }, ErrorCode::bad_pattern);
  EXPECT_NE(refusal.find("more than 128 corners and edges of the ground lie under one sole"),
            std::string::npos)
      << refusal;
}

TEST(Ground, TheSideOfAStepStopsASlidingBlock) {
  World world{.friction = 0.1};
  world.blocks.push_back(step_at({0.3, -1}, {1, 1}, 0.1));
  BlockIn block(world, {0, 0, 0.02});
  RobotState s = block.plant.state();
  s.base_velocity.x() = 1.0;
  block.plant.set_state(s);
  block.run(1.0);
  EXPECT_NEAR(block.position().x(), 0.2, 0.002);  // its front is at the riser
  EXPECT_LT(block.plant.state().base_velocity.norm(), 1e-3);
}

// On a slope the block sticks on the ground and slides on the patch, by Coulomb's law.
TEST(Ground, PatchesHaveTheirOwnFriction) {
  const double angle = 0.3, mu = 0.1;
  World world{.friction = 0.8, .slope = {0, angle}};
  world.patches.push_back({{-0.3, -1}, {5, 1}, mu});
  for (const double y : {0.0, 2.0}) {
    BlockIn block(world, Vector3d::Zero());
    RobotState s = block.plant.state();
    s.base.attitude = exp_rotation({0, angle, 0});
    s.base.position = s.base.attitude * Vector3d(0, y, 0.02);
    block.plant.set_state(s);
    block.run(0.1);
    const Vector3d start = block.position();
    const double v0 = block.plant.state().base_velocity.norm();
    block.run(0.5);
    const double a = kGravity * (std::sin(angle) - mu * std::cos(angle));
    const double distance = y > 1 ? 0 : v0 * 0.5 + 0.5 * a * 0.25;
    EXPECT_NEAR((block.position() - start).norm(), distance, 0.005 * distance + 1e-6);
  }
}

// A height field that is an inclined plane is a slope: a block slides on it as on the slope.
TEST(Ground, AnInclinedFieldIsASlope) {
  const double angle = 0.3, mu = 0.15;
  const World world = test::inclined_field(angle, mu);
  BlockIn block(world, Vector3d::Zero());
  RobotState s = block.plant.state();
  s.base.attitude = exp_rotation({0, angle, 0});
  s.base.position = s.base.attitude * Vector3d(0, 0, 0.02);
  block.plant.set_state(s);
  block.run(0.1);
  const Vector3d start = block.position();
  const double v0 = block.plant.state().base_velocity.norm(), T = 0.6;
  block.run(T);
  const double distance = test::sliding_distance(angle, mu, v0, T);
  EXPECT_NEAR((block.position() - start).norm(), distance, 0.005 * distance);
}

// A block on a floor that is shaken more gently than friction holds moves with the floor; with
// stronger shaking it slips.
TEST(MovingFloor, CarriesABlockAsFarAsFrictionHolds) {
  const double mu = 0.4, w = 2 * M_PI * 2;
  for (const double share : {0.8, 1.5}) {
    const double amplitude = share * mu * kGravity / (w * w);
    BlockIn block(World{.friction = mu}, {0, 0, 0.02});
    const double apart = test::moved_on_floor(block, test::shaking(amplitude), kStep);
    if (share < 1) {
      EXPECT_LT(apart, 1e-6);
    } else {
      EXPECT_GT(apart, 0.2 * amplitude);
    }
  }
}

// The floor tilts slowly: the block tips about its lower edge, at the angle at which the weight
// passes over that edge, and not before.
TEST(MovingFloor, TipsABlockAtTheRightEdgeAndAngle) {
  const Vector3d size(0.06, 0.2, 0.2);
  const double expected = std::atan2(size.x(), size.z());
  const std::vector<FloorMotion> motions = {{0.1, 20, {.tilt = {0, 0.6}}}};
  BlockIn block(World{.friction = 3}, {0, 0, 0.5 * size.z()}, size);
  double tipped_at = 0;
  for (long k = 0; k < 20000 && tipped_at == 0; ++k) {
    block.plant.step(VectorXd(0), test::floor_input(motions, k, kStep), kStep);
    const Eigen::Matrix3d floor =
        floor_pose({}, motions, static_cast<double>(k + 1) * kStep).linear();
    const Eigen::Matrix3d R = block.plant.state().base.attitude.toRotationMatrix();
    const double angle = matrix_to_rpy(floor).y();
    const double tilt = matrix_to_rpy(floor.transpose() * R).y();
    if (angle < 0.98 * expected) {
      ASSERT_LT(std::abs(tilt), 1e-4) << "at " << angle;
    }
    if (tilt > 0.002) {
      tipped_at = angle;
      const Vector3d edge =
          floor.transpose() * (block.position() + R * Vector3d(0.5 * size.x(), 0, -0.5 * size.z()));
      EXPECT_NEAR(edge.x(), 0.5 * size.x(), 1e-3);
      EXPECT_NEAR(edge.z(), 0, 1e-3);
    }
  }
  // From the balance, the block takes a moment to fall by 2 mrad, while the floor continues to
  // tilt.
  EXPECT_GT(tipped_at, 0.995 * expected);
  EXPECT_LT(tipped_at, 1.05 * expected);
}

// Discs smaller than the soles carry the robot between the corners: the cells share the load in
// such a way that its centre is on the disc.
TEST(Ground, BumpsUnderTheSolesCarryBetweenTheirCorners) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const CommandSample start = test::standing(model, 0).samples[0];
  World world;
  std::array<Vector2d, 2> centers;
  for (int side = 0; side < 2; ++side) {
    const Vector2d c = model.sole(static_cast<Side>(side)).center;
    centers[side] = (start.feet[side] * Vector3d(c.x(), c.y(), 0)).head<2>();
    GroundBlock disc;
    disc.kind = GroundBlock::Kind::disc;
    disc.center = centers[side];
    disc.radius = 0.02;
    disc.height = 0.003;
    world.blocks.push_back(disc);
  }
  Plant plant(model, model.limits(), world);
  RobotState s = start.state;
  s.base.position.z() += 0.003;
  plant.set_state(s);
  StepReport report;
  for (int i = 0; i < 1000; ++i) report = plant.step(start.state.theta, {}, kStep);
  double weight = 0;
  for (int side = 0; side < 2; ++side) {
    double fz = 0;
    Vector3d moment = Vector3d::Zero();
    for (const SoleForce& cell : report.soles[side]) {
      fz += cell.force.z();
      moment += cell.force.z() * cell.position;
    }
    EXPECT_LT((moment.head<2>() / fz - centers[side]).norm(), 0.021) << side;
    EXPECT_NEAR(moment.z() / fz, 0.003, 2e-4);
    weight += fz;
  }
  EXPECT_NEAR(weight, model.mass() * kGravity, 0.05);
}

}  // namespace
}  // namespace ayumi
