#pragma once
// Systems of linear equations. The factorizations are compiled here alone, because each of them
// takes a compiler seconds in every source that uses it.

#include <Eigen/Core>

namespace ayumi {

/// x with A x = b by L D L'. A: n x n, symmetric and semidefinite (its lower triangle is read);
/// b: n, or n x m. Where A is singular, directions of its kernel stay 0.
Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

/// x with A x = b by L U with partial pivoting. A: n x n, not singular; b: n, or n x m.
Eigen::VectorXd solve_general(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_general(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

/// The x with the least |A x - b| by QR with column pivoting. A: m x n, m >= n; where its columns
/// are not independent, some entries of x are 0.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Of all x with the least |A x - b| the one with the least |x|, by a complete orthogonal
/// decomposition. A: m x n of any rank; b: m x k, the result n x k.
Eigen::MatrixXd solve_least_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

}  // namespace ayumi
