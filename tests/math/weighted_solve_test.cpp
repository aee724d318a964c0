#include "ayumi/math/weighted_solve.hpp"

#include <gtest/gtest.h>

#include "tests/support/dense.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// (22)(23): the solution meets the task, and no other solution of the task costs less.
TEST(WeightedLeastNorm, MeetsTheTaskAtLeastCost) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const int m = 3 + static_cast<int>(seed % 9), n = 20;
    MatrixXd J(m, n);
    for (int i = 0; i < m; ++i) J.row(i) = random.vector(n, 1.0).transpose();
    const VectorXd u = random.vector(m, 1.0), x0 = random.vector(n, 1.0);
    const VectorXd w = random.vector(n, 1.0).cwiseAbs() + VectorXd::Constant(n, 0.1);
    const VectorXd x = weighted_least_norm(J, u, w, x0);
    EXPECT_LT((J * x - u).norm(), 1e-11);
    auto cost = [&](const VectorXd& y) { return (y - x0).dot(w.asDiagonal() * (y - x0)); };
    for (int i = 0; i < 10; ++i) {
      const VectorXd step = random.vector(n, 0.1);
      const VectorXd other =
          x + step - J.transpose() * test::solve_dense(J * J.transpose(), J * step);
      EXPECT_GT(cost(other), cost(x));
    }
  }
}

// (28)(29) are (22)(23) with no commanded rates.
TEST(WeightedLeastNorm, WithoutACommandIsThePlainLeastNorm) {
  test::Random random(3);
  MatrixXd J(2, 5);
  for (int i = 0; i < 2; ++i) J.row(i) = random.vector(5, 1.0).transpose();
  const VectorXd u = random.vector(2, 1.0);
  const VectorXd x = weighted_least_norm(J, u, VectorXd::Ones(5), VectorXd::Zero(5));
  const VectorXd least = J.transpose() * test::solve_dense(J * J.transpose(), u);
  EXPECT_LT((x - least).norm(), 1e-13);
}

TEST(WeightedLeastNorm, AHeavyJointMovesLess) {
  const MatrixXd J = MatrixXd::Ones(1, 2);
  const VectorXd w = (VectorXd(2) << 1, 9).finished();
  const VectorXd x = weighted_least_norm(J, VectorXd::Ones(1), w, VectorXd::Zero(2));
  EXPECT_NEAR(x[0] / x[1], 9, 1e-12);
}

TEST(WeightedLeastNorm, DampingBoundsASingularTask) {
  const MatrixXd J = (MatrixXd(2, 2) << 1, 1, 1, 1 + 1e-6).finished();
  const VectorXd u = (VectorXd(2) << 0, 1).finished();
  const VectorXd free = weighted_least_norm(J, u, VectorXd::Ones(2), VectorXd::Zero(2), 0);
  const VectorXd damped = weighted_least_norm(J, u, VectorXd::Ones(2), VectorXd::Zero(2), 1e-5);
  EXPECT_GT(free.norm(), 1e5);
  EXPECT_LT(damped.norm(), 10);
}

}  // namespace
}  // namespace ayumi
