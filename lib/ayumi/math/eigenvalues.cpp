#include "ayumi/math/eigenvalues.hpp"

#include <Eigen/Dense>

namespace ayumi {

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& A) {
  if (!A.allFinite()) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, false);
  if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) return std::nullopt;
  return solver.eigenvalues();
}

Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& A) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace ayumi
