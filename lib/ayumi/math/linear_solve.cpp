#include "ayumi/math/linear_solve.hpp"

#include <Eigen/Dense>

namespace ayumi {

Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  return A.ldlt().solve(b);
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.ldlt().solve(b);
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return A.ldlt().solve(b);
}

Eigen::VectorXd solve_general(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.partialPivLu().solve(b);
}

Eigen::MatrixXd solve_general(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return A.partialPivLu().solve(b);
}

Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd solve_least_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

}  // namespace ayumi
