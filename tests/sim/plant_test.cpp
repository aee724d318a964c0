#include "ayumi/sim/plant/plant.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/block.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

struct BlockOnSlope {
  BlockOnSlope(double angle, double friction, const Vector3d& size = {0.2, 0.1, 0.04})
      : model(test::block_description(size, 2.0)),
        plant(model, model.limits(), World{friction, {0, angle}}) {
    RobotState s = model.rest_state();
    s.base.attitude = exp_rotation({0, angle, 0});
    s.base.position = s.base.attitude * Vector3d(0, 0, 0.5 * size.z());
    plant.set_state(s);
  }
  void run(double time, double dt = 1e-3) {
    for (long i = 0; i < std::lround(time / dt); ++i) plant.step(VectorXd(0), {}, dt);
  }
  RobotModel model;
  Plant plant;
};

// A rotation about +y by a positive angle turns x downhill.
TEST(Block, SlidesDownASlopeByCoulombsLaw) {
  const double angle = 0.4, mu = 0.2;
  BlockOnSlope block(angle, mu);
  block.run(0.2);
  const Vector3d start = block.plant.state().base.position;
  const double v0 = block.plant.state().base_velocity.norm();
  const double T = 0.8;
  block.run(T);
  const double a = kGravity * (std::sin(angle) - mu * std::cos(angle));
  const double distance = (block.plant.state().base.position - start).norm();
  EXPECT_NEAR(distance, v0 * T + 0.5 * a * T * T, 0.005 * distance);
}

TEST(Block, SlidesAndStopsByCoulombsLaw) {
  const double mu = 0.3, v0 = 1.0;
  BlockOnSlope block(0, mu);
  block.run(0.2);
  RobotState s = block.plant.state();
  s.base_velocity.x() = v0;
  block.plant.set_state(s);
  block.run(1.0);
  EXPECT_NEAR(block.plant.state().base.position.x() - s.base.position.x(),
              v0 * v0 / (2 * mu * kGravity), 0.005 * v0 * v0 / (2 * mu * kGravity));
  EXPECT_LT(block.plant.state().base_velocity.norm(), 1e-9);
}

TEST(Plant, ACopyContinuesAloneAndToTheSameBits) {
  BlockOnSlope block(0.4, 0.2);
  block.run(0.1);
  const Vector3d start = block.plant.state().base.position;
  Plant copy = block.plant;
  block.run(0.1);
  EXPECT_EQ(copy.state().base.position, start);
  EXPECT_NE(block.plant.state().base.position, start);
  for (int i = 0; i < 100; ++i) copy.step(VectorXd(0), {}, 1e-3);
  EXPECT_EQ(copy.state().base.position, block.plant.state().base.position);
  EXPECT_EQ(copy.state().base_velocity, block.plant.state().base_velocity);
}

TEST(Block, SticksBelowTheFrictionAngleWithoutCreep) {
  BlockOnSlope block(0.3, 0.35);
  block.run(1.0);
  const Vector3d start = block.plant.state().base.position;
  block.run(1.0);
  EXPECT_LT((block.plant.state().base.position - start).norm(), 1e-9);
}

TEST(Block, TipsAtTheRightAngle) {
  // Half the length is 0.02 and half the height 0.05: the block tips beyond atan(0.4).
  const double critical = std::atan(0.4);
  for (const double share : {0.97, 1.03}) {
    BlockOnSlope block(share * critical, 5.0, {0.04, 0.1, 0.1});
    block.run(1.5);
    const double tilt = matrix_to_rpy(block.plant.state().base.attitude.toRotationMatrix()).y();
    if (share < 1)
      EXPECT_NEAR(tilt, share * critical, 0.02);
    else
      EXPECT_GT(tilt, critical + 0.3);
  }
}

TEST(Block, AtRestCarriesItsWeight) {
  BlockOnSlope block(0, 0.5);
  block.run(1.0);
  EXPECT_LT(block.plant.state().base_velocity.norm(), 1e-12);
  EXPECT_NEAR(block.plant.state().base.position.z(), 0.02, 2e-4);
}

class Flight : public testing::TestWithParam<unsigned> {};

TEST_P(Flight, KeepsMomentumUnderItsServos) {
  RobotDescription d = test::random_tree(GetParam(), 12, false);
  for (const JointDescription& joint : d.joints)
    if (joint.type != JointType::fixed) d.servos[joint.name] = {50.0, 1.0, 0.003, 0.0, 0.0};
  const RobotModel model(d);
  Plant plant(model, model.limits(), World{});
  test::Random random(GetParam());
  RobotState s = test::random_state(model, random);
  s.base.position.z() = 100;
  plant.set_state(s);
  RobotData data(model);
  update_velocities(model, s, data);
  const Momentum before = centroidal_momentum(model, data);
  const VectorXd targets = random.vector(model.dof_count(), 0.5);
  for (int i = 0; i < 500; ++i) plant.step(targets, {}, 1e-3);
  update_velocities(model, plant.state(), data);
  const Momentum after = centroidal_momentum(model, data);
  const Vector3d expected = before.linear - Vector3d(0, 0, model.mass() * kGravity * 0.5);
  EXPECT_LT((after.linear - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((after.angular - before.angular).norm(), 1e-11 * (1 + before.angular.norm()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Flight, testing::Range(1u, 6u));

}  // namespace
}  // namespace ayumi
