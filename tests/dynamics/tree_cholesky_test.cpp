#include "ayumi/dynamics/tree_cholesky.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class Trees : public testing::TestWithParam<unsigned> {};

TEST_P(Trees, SolveAsADenseFactorDoes) {
  for (const bool mimic : {false, true}) {
    RobotDescription d = test::random_tree(GetParam(), 14, mimic);
    const RobotModel model(d);
    test::Random random(GetParam() + 50);
    RobotData data(model);
    const RobotState state = test::random_state(model, random);
    update_velocities(model, state, data);
    MatrixXd M;
    mass_matrix(model, data, M);
    TreeCholesky tree(model);
    ASSERT_TRUE(tree.factor(M));
    const VectorXd b = random.vector(model.velocity_count(), 1.0);
    VectorXd x = b;
    tree.solve(x);
    EXPECT_LT((M * x - b).norm(), 1e-12 * M.norm() * x.norm());
    const VectorXd dense = M.llt().solve(b);
    EXPECT_LT((x - dense).norm(), 1e-9 * dense.norm());
    M(0, 0) = -1;
    EXPECT_FALSE(tree.factor(M));
  }
}

TEST_P(Trees, MovedBaseIsAnUpdateOfThePositions) {
  const RobotModel model(test::random_tree(GetParam(), 12));
  test::Random random(GetParam());
  const RobotState a = test::random_state(model, random);
  RobotState b = test::random_state(model, random);
  b.theta = a.theta;
  b.dtheta = a.dtheta;
  RobotData moved(model), fresh(model);
  RobotState still = a;
  still.base = b.base;
  still.base_velocity.setZero();
  still.base_angular_velocity.setZero();
  update_positions(model, a, moved);
  move_base(b.base, moved);
  update_velocities(model, b, fresh);
  const auto close = [](const auto& x, const auto& y) { return (x - y).norm() < 1e-13; };
  EXPECT_TRUE(close(moved.cog, fresh.cog));
  for (size_t i = 0; i < moved.position.size(); ++i) {
    EXPECT_TRUE(close(moved.position[i], fresh.position[i])) << i;
    EXPECT_TRUE(close(moved.rotation[i], fresh.rotation[i])) << i;
    EXPECT_TRUE(close(moved.axis[i], fresh.axis[i])) << i;
    EXPECT_TRUE(close(moved.com[i], fresh.com[i])) << i;
  }
  update_velocities(model, still, moved);
  add_base_velocity(b.base_velocity, b.base_angular_velocity, moved);
  EXPECT_LT((moved.dcog - fresh.dcog).norm(), 1e-12);
  for (size_t i = 0; i < moved.position.size(); ++i) {
    EXPECT_LT((moved.velocity[i] - fresh.velocity[i]).norm(), 1e-12) << i;
    EXPECT_LT((moved.angular_velocity[i] - fresh.angular_velocity[i]).norm(), 1e-12) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Trees, testing::Range(1u, 9u));

}  // namespace
}  // namespace ayumi
