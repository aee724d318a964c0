#pragma once
// The discrete algebraic Riccati equation of linear quadratic regulators.

#include <Eigen/Core>

namespace ayumi {

/// The P that belongs to the stabilizing feedback u = -(R + B'PB)^-1 B'PA x of x+ = A x + B u with
/// the least sum of x'Q x + u'R u:
///   P = A'PA - A'PB (R + B'PB)^-1 B'PA + Q.
/// A is n x n, B is n x m, Q is n x n, symmetric and semidefinite, and R is m x m, symmetric and
/// definite. Throws Error(internal) if there is no such P.
Eigen::MatrixXd solve_riccati(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                              const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R);

/// The gain (R + B'PB)^-1 B'PA.
Eigen::MatrixXd regulator_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                               const Eigen::MatrixXd& R, const Eigen::MatrixXd& P);

}  // namespace ayumi
