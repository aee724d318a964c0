#include "ayumi/math/weighted_solve.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// (22)(23): meets the task, and no other solution of the task costs less.
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
    const MatrixXd kernel = J.fullPivLu().kernel();
    for (int i = 0; i < 10; ++i) {
      const VectorXd other = x + kernel * random.vector(static_cast<int>(kernel.cols()), 0.1);
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
  EXPECT_LT((x - J.completeOrthogonalDecomposition().solve(u)).norm(), 1e-13);
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

// Twelve rows known to be partly zero give what the general solve gives; so do tasks that say the
// same thing twice, where the factor breaks down.
TEST(WeightedLeastNorm, OfBodyTasksIsThatOfAnyTasks) {
  test::Random random(5);
  BodyTasks tasks;
  const int n = 20;
  tasks.J.setZero(BodyTasks::kRows, n);
  for (int j = 0; j < n; ++j) {
    tasks.lead.push_back(j < 8 ? 12 : j < 14 ? 9 : 3);
    tasks.J.col(j).head(tasks.lead.back()) = random.vector(tasks.lead.back(), 1.0);
  }
  tasks.u = random.vector(BodyTasks::kRows, 1.0);
  const VectorXd w = (random.vector(n, 1.0).array() + 1.5).matrix(), x0 = random.vector(n, 1.0);
  VectorXd x;
  for (const double damping : {0.0, 1e-5}) {
    weighted_least_norm(tasks, w, x0, damping, x);
    const VectorXd expected = weighted_least_norm(tasks.J, tasks.u, w, x0, damping);
    EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  }
  EXPECT_LT((tasks.J * x - tasks.u).norm(), 1e-3);
  tasks.J.row(1) = tasks.J.row(0);
  tasks.u[1] = tasks.u[0];
  weighted_least_norm(tasks, w, x0, 0, x);
  EXPECT_LT((tasks.J * x - tasks.u).norm(), 1e-8);
}

}  // namespace
}  // namespace ayumi
