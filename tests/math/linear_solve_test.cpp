#include "ayumi/math/linear_solve.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(test::Random& random, int rows, int columns) {
  MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i) m.row(i) = random.vector(columns, 1.0).transpose();
  return m;
}

TEST(LinearSolve, MeetsTheEquations) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const int n = 1 + static_cast<int>(seed);
    const MatrixXd root = random_matrix(random, n, n);
    const MatrixXd A = root * root.transpose() + MatrixXd::Identity(n, n);
    const MatrixXd B = random_matrix(random, n, 4);
    const VectorXd b = B.col(0);
    EXPECT_LT((A * solve_symmetric(A, b) - b).norm(), 1e-10);
    EXPECT_LT((A * solve_symmetric(A, B) - B).norm(), 1e-10);
    const MatrixXd general = root + 10 * MatrixXd::Identity(n, n);
    EXPECT_LT((general * solve_general(general, b) - b).norm(), 1e-10);
    EXPECT_LT((general * solve_general(general, B) - B).norm(), 1e-10);
    const Eigen::Matrix3d small = A(0, 0) * Eigen::Matrix3d::Identity() +
                                  Eigen::Vector3d(1, 2, 3) * Eigen::RowVector3d(1, 2, 3);
    const Eigen::Vector3d right(4, -5, 6);
    EXPECT_LT((small * solve_symmetric(small, right) - right).norm(), 1e-10);
  }
}

// The remainder is perpendicular to every column; two equal columns do no harm.
TEST(LinearSolve, LeastSquaresLeaveWhatIsPerpendicular) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    MatrixXd A = random_matrix(random, 30, 5);
    if (seed % 2 == 0) A.col(4) = A.col(1);
    const VectorXd b = random_matrix(random, 30, 1).col(0);
    const VectorXd left = b - A * solve_least_squares(A, b);
    EXPECT_LT((A.transpose() * left).norm(), 1e-12);
    EXPECT_GT(left.norm(), 0.1);
  }
}

// The matrix has rank 4 in 7 columns: the remainder is perpendicular to the columns, and the
// solution to the kernel.
TEST(LinearSolve, LeastNormStaysOutOfTheKernel) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const MatrixXd rows = random_matrix(random, 4, 7);
    const MatrixXd A = random_matrix(random, 12, 4) * rows;
    const MatrixXd b = random_matrix(random, 12, 2);
    const MatrixXd x = solve_least_norm(A, b);
    EXPECT_LT((A.transpose() * (b - A * x)).norm(), 1e-11);
    const MatrixXd square = rows * rows.transpose(), right = rows * x;
    const MatrixXd in_rows = rows.transpose() * solve_general(square, right);
    EXPECT_LT((x - in_rows).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace ayumi
