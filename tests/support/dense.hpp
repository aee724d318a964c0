#pragma once
// Dense matrices in the tests. What is compiled once here takes seconds in every test that names
// it.

#include <Eigen/Core>

namespace ayumi::test {

/// The x with A x = b, by LU decomposition with partial pivoting. A is square and regular.
Eigen::VectorXd solve_dense(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

double determinant(const Eigen::MatrixXd& A);

}  // namespace ayumi::test
