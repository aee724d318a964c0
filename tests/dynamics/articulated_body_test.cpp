#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::VectorXd;

class ArticulatedBodies : public testing::TestWithParam<unsigned> {};

TEST_P(ArticulatedBodies, AgreeWithTheMassMatrixAndUndoInverseDynamics) {
  for (const bool mimic : {false, true}) {
    const RobotModel model(test::random_tree(GetParam(), 12, mimic));
    test::Random random(GetParam() + 20);
    RobotData data(model);
    VectorXd found;
    for (int trial = 0; trial < 20; ++trial) {
      const RobotState state = test::random_state(model, random);
      const VectorXd wanted = random.vector(model.velocity_count(), 5.0);
      const VectorXd force = inverse_dynamics(model, state, wanted, data);
      RobotData fresh(model);
      articulated_body_acceleration(model, state, force, fresh, found);
      const VectorXd dense = forward_dynamics(model, state, force, data);
      EXPECT_LT((found - wanted).norm(), 1e-9 * wanted.norm());
      EXPECT_LT((found - dense).norm(), 1e-9 * wanted.norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ArticulatedBodies, testing::Range(1u, 11u));

}  // namespace
}  // namespace ayumi
