#pragma once
// Systems of linear equations. The factorizations are compiled here alone, because each of them
// takes a compiler seconds in every source that uses it.

#include <Eigen/Core>

namespace ayumi {

/// The x with A x = b by L D L'. A is n x n, symmetric and semidefinite (only its lower triangle is
/// read); b is n or n x m. If A is singular, directions of its kernel stay 0.
Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

/// The x with A x = b by L U with partial pivoting. A is n x n and not singular; b is n or n x m.
Eigen::VectorXd solve_general(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_general(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

/// The x with the least |A x - b| by QR with column pivoting. A is m x n with m >= n; if its
/// columns are not independent, some entries of x are 0.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Of all x with the least |A x - b|, the one with the least |x|, by a complete orthogonal
/// decomposition. A is m x n of any rank, b is m x k, and the result n x k.
Eigen::MatrixXd solve_least_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

}  // namespace ayumi
