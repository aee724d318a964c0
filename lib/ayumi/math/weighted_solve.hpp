#pragma once
// The weighted least-norm solve of (22)(23) and (28)(29).

#include <Eigen/Dense>

namespace ayumi {

/// The x nearest to x0 in the norm W = diag(w) with J x = u:
///   x = x0 + W^-1 J' (J W^-1 J' + lambda I)^-1 (u - J x0),  lambda = damping * trace / rows,
/// (23) with v = u - J x0 (the printed sign is wrong, docs/notation.md). J is m x n, w > 0 has n
/// entries, and u has m.
Eigen::VectorXd weighted_least_norm(const Eigen::MatrixXd& J, const Eigen::VectorXd& u,
                                    const Eigen::VectorXd& w, const Eigen::VectorXd& x0,
                                    double damping = 0);

}  // namespace ayumi
