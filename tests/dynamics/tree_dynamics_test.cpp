#include "ayumi/dynamics/tree_dynamics.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class FastTrees : public testing::TestWithParam<unsigned> {
 protected:
  FastTrees() : random(GetParam() + 90) {}
  /// Trees with and without tied joints, with axes of every kind.
  std::vector<RobotModel> models() const {
    const int links = 5 + static_cast<int>(GetParam());
    return {RobotModel(test::random_tree(GetParam(), links, false)),
            RobotModel(test::random_tree(GetParam(), links, true)),
            RobotModel(test::odd_tree(GetParam(), links)),
            RobotModel(test::FreedTree::freed(test::odd_tree(GetParam(), links)))};
  }
  test::Random random;
};

TEST_P(FastTrees, AgreeWithTheRecursionsInWorldAxes) {
  for (const RobotModel& model : models()) {
    RobotData data(model);
    TreeDynamics fast(model);
    const int n = model.dof_count();
    const JointDrive drive{random.vector(n, 0.01).cwiseAbs(), random.vector(n, 0.1),
                           random.vector(n, 0.1)};
    VectorXd found, expected;
    for (int trial = 0; trial < 10; ++trial) {
      const RobotState state = test::random_state(model, random);
      const VectorXd input = random.vector(model.velocity_count(), 5.0);
      expected = inverse_dynamics(model, state, input, data);
      fast.inverse(state, input, found);
      EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
      expected = forward_dynamics(model, state, input, data);
      fast.forward(state, input, found);
      EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm());
      // Rotors and friction: (M + rotors) a = f - b - friction.
      MatrixXd M, quick;
      mass_matrix(model, data, M);
      const VectorXd bias = bias_force(model, state, data);
      MatrixXd driven = M;
      driven.diagonal().tail(n) += drive.rotor_inertia;
      VectorXd rest = input - bias;
      rest.tail(n) -= drive_torque(drive, state.dtheta, VectorXd::Zero(n));
      fast.forward(state, input, found, &drive);
      EXPECT_LT((driven * found - rest).norm(), 1e-12 * driven.norm() * found.norm());
      fast.mass_matrix(state, quick);
      EXPECT_LT((quick - M).norm(), 1e-13 * M.norm());
      EXPECT_EQ((quick - quick.transpose()).norm(), 0);
      fast.forward(state, input, found);
      VectorXd back;
      fast.inverse(state, found, back);
      EXPECT_LT((back - input).norm(), 1e-12 * (1 + found.norm()));
    }
  }
}

// To the last bit, nothing depends on the instruction set or on the neighbours in a batch.
TEST_P(FastTrees, GiveTheSameBitsAloneAndInAnyBatch) {
  for (const RobotModel& model : models()) {
    TreeDynamics plain(model, InstructionSet::plain), best(model);
    const JointDrive drive{random.vector(model.dof_count(), 0.01).cwiseAbs(),
                           random.vector(model.dof_count(), 0.1),
                           random.vector(model.dof_count(), 0.1)};
    std::vector<RobotState> states;
    for (int k = 0; k < 11; ++k) states.push_back(test::random_state(model, random));
    const MatrixXd input =
        MatrixXd::NullaryExpr(model.velocity_count(), 11, [&] { return random.uniform(-3, 3); });
    VectorXd alone;
    MatrixXd a, b;
    plain.inverse(states, input, a);
    best.inverse(states, input, b);
    EXPECT_EQ(a, b);
    for (int k = 0; k < 11; ++k) {
      best.inverse(states[static_cast<size_t>(k)], input.col(k), alone);
      EXPECT_EQ(alone, a.col(k));
    }
    std::vector<VectorXd> accelerations;
    std::vector<TreeDynamics::Motion> motions;
    for (int k = 0; k < 11; ++k) accelerations.push_back(input.col(k));
    for (size_t k = 0; k < 11; ++k) motions.push_back({&states[k], &accelerations[k]});
    best.inverse(motions, b);
    EXPECT_EQ(a, b);
    plain.forward(states, input, a, &drive);
    best.forward(states, input, b, &drive);
    EXPECT_EQ(a, b);
    plain.mass_matrix(states[0], a);
    best.mass_matrix(states[0], b);
    EXPECT_EQ(a, b);
    plain.forward(states, input, a, &drive);
    for (int k = 0; k < 11; ++k) {
      plain.forward(states[static_cast<size_t>(k)], input.col(k), alone, &drive);
      EXPECT_EQ(alone, a.col(k));
    }
  }
}

// The series for sine and cosine is tested over the whole circle, for many turns and beyond its
// range.
TEST(FastTreesAngles, GoAnyNumberOfTurns) {
  const RobotModel model(test::random_tree(4, 12, false));
  RobotData data(model);
  TreeDynamics fast(model);
  test::Random random(4);
  const VectorXd acceleration = random.vector(model.velocity_count(), 5.0);
  RobotState state = test::random_state(model, random);
  VectorXd found;
  for (const double scale : {4.0, 100.0, 9e4, 1e7}) {
    for (int trial = 0; trial < 50; ++trial) {
      for (int j = 0; j < model.dof_count(); ++j)
        if (!model.dofs()[static_cast<size_t>(j)].prismatic)
          state.theta[j] =
              trial < 9 && scale < 5 ? (trial - 4) * M_PI / 4 : random.uniform(-scale, scale);
      fast.inverse(state, acceleration, found);
      const VectorXd expected = inverse_dynamics(model, state, acceleration, data);
      ASSERT_LT((found - expected).norm(), 1e-13 * expected.norm()) << scale << " rad";
    }
  }
}

TEST(FastTreesBatch, OfNoStateIsEmpty) {
  const RobotModel model(test::random_tree(4, 6, false));
  TreeDynamics fast(model);
  MatrixXd force;
  fast.inverse(std::vector<RobotState>(), MatrixXd(model.velocity_count(), 0), force);
  EXPECT_EQ(force.cols(), 0);
  EXPECT_EQ(force.rows(), model.velocity_count());
}

INSTANTIATE_TEST_SUITE_P(Seeds, FastTrees, testing::Range(1u, 13u));

}  // namespace
}  // namespace ayumi
