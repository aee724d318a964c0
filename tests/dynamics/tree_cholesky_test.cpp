#include "ayumi/dynamics/tree_cholesky.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "tests/support/dense.hpp"
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
    const VectorXd dense = test::solve_dense(M, b);
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
  carry_velocities(model, b, moved);
  EXPECT_LT((moved.dcog - fresh.dcog).norm(), 1e-12);
  for (size_t i = 0; i < moved.position.size(); ++i) {
    EXPECT_LT((moved.velocity[i] - fresh.velocity[i]).norm(), 1e-12) << i;
    EXPECT_LT((moved.angular_velocity[i] - fresh.angular_velocity[i]).norm(), 1e-12) << i;
  }
}

// The parts that the plant uses separately: rows, products, halves of the solve, several right
// sides.
TEST_P(Trees, RowsAndPathsAreTheMatrixAndItsChains) {
  for (const bool mimic : {false, true}) {
    const RobotModel model(test::random_tree(GetParam(), 14, mimic));
    test::Random random(GetParam() + 70);
    const int n = model.velocity_count();
    RobotData data(model);
    update_positions(model, test::random_state(model, random), data);
    MatrixXd M;
    mass_matrix(model, data, M);
    TreeCholesky tree(model);
    std::vector<double> rows(tree.row_doubles(), 0.0);
    data.kernels->mass_entries(data.tree(), data.bodies(), tree.layout(), rows.data());
    const VectorXd x = random.vector(n, 1.0);
    VectorXd placed(n), product;
    for (int k = 0; k < n; ++k) placed[k] = x[tree.column_at(k)];
    tree.multiply(rows, placed, product);
    for (int k = 0; k < n; ++k)
      EXPECT_NEAR(product[k], (M * x)[tree.column_at(k)], 1e-12 * M.norm()) << k;

    tree.rows() = rows;
    ASSERT_TRUE(tree.factor_rows());
    const int last = tree.last_place(static_cast<int>(model.bodies().size()) - 1), width = 8;
    std::vector<double> Y;
    MatrixXd right = MatrixXd::Zero(n, width);
    std::vector<int> path;
    for (int k = last; k >= 0; k = tree.parent(k)) path.insert(path.begin(), k);
    ASSERT_EQ(static_cast<int>(path.size()), tree.depth(last) + 1);
    for (const int k : path) {
      right.row(k) = random.vector(width, 1.0).transpose();
      for (int c = 0; c < width; ++c) Y.push_back(right(k, c));
    }
    tree.solve_path(last, width, Y.data());
    for (int c = 0; c < width; ++c) {
      VectorXd y = right.col(c);
      tree.solve_upper(y);
      for (size_t t = 0; t < path.size(); ++t)
        EXPECT_NEAR(y[path[t]], Y[t * width + static_cast<size_t>(c)], 1e-11 * y.norm());
    }
  }
}

// Every instruction set gives the same bits.
TEST_P(Trees, DoNotDependOnTheInstructionSet) {
  const RobotModel model(test::random_tree(GetParam(), 14, GetParam() % 2 == 0));
  test::Random random(GetParam() + 90);
  RobotData a(model, kernels::plain_kernels()), b(model);
  TreeCholesky of_a(model, kernels::plain_kernels()), of_b(model);
  for (int trial = 0; trial < 5; ++trial) {
    const RobotState state = test::random_state(model, random);
    const VectorXd acceleration = random.vector(model.velocity_count(), 3.0);
    VectorXd force_a, force_b;
    MatrixXd M_a, M_b;
    update_velocities(model, state, a);
    update_velocities(model, state, b);
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.com, b.com);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.angular_velocity, b.angular_velocity);
    EXPECT_EQ(a.cog, b.cog);
    EXPECT_EQ(a.dcog, b.dcog);
    newton_euler(model, state, acceleration, a, force_a);
    newton_euler(model, state, acceleration, b, force_b);
    EXPECT_EQ(force_a, force_b);
    mass_matrix(model, a, M_a);
    mass_matrix(model, b, M_b);
    EXPECT_EQ(M_a, M_b);
    ASSERT_TRUE(of_a.factor(M_a) && of_b.factor(M_b));
    of_a.solve(force_a);
    of_b.solve(force_b);
    EXPECT_EQ(force_a, force_b);
  }
}

// Products and solves of small dense matrices, against Eigen's.
TEST(SmallMatrices, AgreeWithEigenAndDoNotDependOnTheInstructionSet) {
  test::Random random(4);
  for (const int size : {1, 3, 6, 11, 24, 30}) {
    const int width = (size + 3) / 4 * 4, depth = size + 8;
    MatrixXd A = MatrixXd::Zero(width, depth), B = MatrixXd::Zero(8, depth);
    for (int t = 0; t < depth; ++t) {
      A.col(t).head(size) = random.vector(size, 1.0);
      B.col(t) = random.vector(8, 1.0);
    }
    const VectorXd x = random.vector(size, 1.0);
    std::vector<MatrixXd> products, squares;
    for (const kernels::Kernels* each : {&kernels::plain_kernels(), &kernels::best_kernels()}) {
      MatrixXd product(width, 8), square(width, width);
      each->gram(A.data(), width, B.data(), 8, depth, width, 8, product.data(), width);
      EXPECT_LT((product - A * B.transpose()).norm(), 1e-13 * product.norm());
      each->gram(A.data(), width, A.data(), width, depth, width, width, square.data(), width);
      MatrixXd part = MatrixXd::Constant(width + 2, width + 1, 7);
      each->gram(A.data(), width, A.data(), width, depth, size, size, part.data(), width + 2);
      EXPECT_EQ(part.topLeftCorner(size, size), square.topLeftCorner(size, size));
      EXPECT_EQ(part.bottomRows(2 + width - size).minCoeff(), 7);
      EXPECT_EQ(part.rightCols(1 + width - size).minCoeff(), 7);
      VectorXd sum = x.replicate(1, 1), plain_sum = x + square.topLeftCorner(size, size) * x;
      each->multiply_add(square.data(), size, size, width, x.data(), sum.data());
      EXPECT_LT((sum - plain_sum).norm(), 1e-13 * plain_sum.norm());
      const MatrixXd inner = square.topLeftCorner(size, size);
      VectorXd solved = VectorXd::Zero(width);
      solved.head(size) = x;
      ASSERT_TRUE(each->solve_positive(square.data(), size, width, solved.data()));
      EXPECT_LT((inner * solved.head(size) - x).norm(), 1e-10 * x.norm());
      products.push_back(product);
      squares.push_back(square.topLeftCorner(size, size));
      square.setIdentity();
      square(size - 1, size - 1) = -1;
      EXPECT_FALSE(each->solve_positive(square.data(), size, width, solved.data()));
    }
    EXPECT_EQ(products[0], products[1]);
    EXPECT_EQ(MatrixXd(squares[0].triangularView<Eigen::Lower>()),
              MatrixXd(squares[1].triangularView<Eigen::Lower>()));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Trees, testing::Range(1u, 9u));

}  // namespace
}  // namespace ayumi
