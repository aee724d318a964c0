#pragma once
// Eigenvalues of small matrices. The decompositions are compiled here alone, because each of them
// takes a compiler seconds in every source that uses it.

#include <Eigen/Core>
#include <optional>

namespace ayumi {

/// The eigenvalues of a square matrix A, n x n, in the order of its Schur form: n values. Empty if
/// A is not finite, or if the QR iteration does not converge.
std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& A);

/// The eigenvalues of a symmetric A in rising order. Only its lower triangle is read.
Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& A);

}  // namespace ayumi
