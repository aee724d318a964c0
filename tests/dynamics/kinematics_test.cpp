// Tests of (1)-(13): velocities and Jacobians of a robot whose foot stays where it is.

#include "ayumi/dynamics/kinematics.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

class Anchored : public testing::TestWithParam<Side> {
 protected:
  Anchored() : model(load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json")), data(model) {
    test::Random random(11);
    state = model.rest_state();
    state.theta += random.vector(model.dof_count(), 0.2);
    state.base.attitude = exp_rotation(random.vector(0.3));
    state.base.position = random.vector(1.0);
    dtheta = random.vector(model.dof_count(), 1.0);
    update_positions(model, state, data);
    sole = sole_pose(model, data, GetParam());
  }

  /// The state after the joints have moved for a time t while the sole is held.
  RobotState moved(double t) {
    RobotState s = state;
    s.theta += t * dtheta;
    anchor_base(model, GetParam(), sole, s, data);
    return s;
  }

  RobotModel model;
  RobotData data;
  RobotState state;
  VectorXd dtheta;
  Isometry3d sole;
};

// (13) against differences of the COG.
TEST_P(Anchored, CogJacobianMatchesDifferences) {
  const MatrixXd J = cog_jacobian(model, data, GetParam());
  const double h = 1e-5;
  moved(h);
  const Vector3d after = data.cog;
  moved(-h);
  EXPECT_LT(((after - data.cog) / (2 * h) - J * dtheta).norm(), 1e-9);
}

// (10)(11): the base moves so that the foot does not move.
TEST_P(Anchored, VelocityMapHoldsTheSole) {
  const MatrixXd map = anchored_velocity_map(model, data, GetParam());
  const VectorXd velocity = map * dtheta;
  const MatrixXd J = body_jacobian(model, data, model.sole(GetParam()).body, sole.translation());
  EXPECT_LT((J * velocity).norm(), 1e-12);
  EXPECT_LT((velocity.tail(model.dof_count()) - dtheta).norm(), 1e-15);
  const double h = 1e-5;
  const RobotState after = moved(h), before = moved(-h);
  const Vector3d rate = (after.base.position - before.base.position) / (2 * h);
  EXPECT_LT((rate - velocity.head<3>()).norm(), 1e-9);
  const Vector3d turn =
      log_rotation(after.base.attitude * before.base.attitude.conjugate()) / (2 * h);
  EXPECT_LT((turn - velocity.segment<3>(3)).norm(), 1e-9);
}

// Moving or turning the world only changes the frame.
TEST_P(Anchored, CogJacobianTurnsWithTheWorld) {
  const MatrixXd J = cog_jacobian(model, data, GetParam());
  const Eigen::Quaterniond turn = exp_rotation({0.3, -0.2, 1.5});
  state.base.position = turn * state.base.position + Vector3d(100, -50, 3);
  state.base.attitude = turn * state.base.attitude;
  update_positions(model, state, data);
  EXPECT_LT((cog_jacobian(model, data, GetParam()) - turn.toRotationMatrix() * J).norm(), 1e-13);
}

TEST_P(Anchored, AnchoringPutsTheSoleWhereItIsAsked) {
  const RobotState s = moved(0.3);
  EXPECT_TRUE(sole_pose(model, data, GetParam()).isApprox(sole, 1e-13));
  EXPECT_NEAR(s.base.attitude.norm(), 1, 1e-14);
}

// (1)(2): velocities along the tree agree with differences of positions.
TEST_P(Anchored, VelocitiesMatchDifferences) {
  test::Random random(12);
  const RobotState s = test::random_state(model, random);
  RobotData now(model), after(model), before(model);
  const double h = 1e-6;
  update_velocities(model, s, now);
  update_positions(model, test::integrate(s, s.velocity(), h), after);
  update_positions(model, test::integrate(s, s.velocity(), -h), before);
  for (size_t i = 0; i < model.bodies().size(); ++i) {
    const Vector3d v = (after.pose(static_cast<int>(i)).translation() -
                        before.pose(static_cast<int>(i)).translation()) /
                       (2 * h);
    EXPECT_LT((v - now.velocity[i]).norm(), 1e-8);
  }
  EXPECT_LT(((after.cog - before.cog) / (2 * h) - now.dcog).norm(), 1e-8);
}

// (13) by screws agrees with (13) by products of Jacobians: the floating Jacobian of the COG times
// the generalised velocity that holds the sole.
TEST_P(Anchored, CogJacobianByASecondRoute) {
  MatrixXd J;
  cog_jacobian(model, data, GetParam(), J);
  const MatrixXd floating = cog_jacobian_floating(model, data);
  const MatrixXd product = floating * anchored_velocity_map(model, data, GetParam());
  EXPECT_LT((J - product).norm(), 1e-13 * J.norm());
  held_base_cog_jacobian(model, data, J);
  EXPECT_LT((J - floating.rightCols(model.dof_count())).norm(), 1e-13 * J.norm());
}

INSTANTIATE_TEST_SUITE_P(Feet, Anchored, testing::Values(Side::left, Side::right),
                         [](const auto& side) { return name_of(side.param); });

}  // namespace
}  // namespace ayumi
