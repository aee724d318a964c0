#include "tests/support/dense.hpp"

#include <Eigen/LU>

namespace ayumi::test {

Eigen::VectorXd solve_dense(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.partialPivLu().solve(b);
}

double determinant(const Eigen::MatrixXd& A) { return A.determinant(); }

}  // namespace ayumi::test
