#include "ayumi/math/weighted_solve.hpp"

#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

Eigen::VectorXd weighted_least_norm(const Eigen::MatrixXd& J, const Eigen::VectorXd& u,
                                    const Eigen::VectorXd& w, const Eigen::VectorXd& x0,
                                    double damping) {
  const Eigen::MatrixXd JW = J * w.cwiseInverse().asDiagonal();
  // With few tasks and joints, the plain product is faster than the product by blocks.
  Eigen::MatrixXd A = JW.lazyProduct(J.transpose());
  if (damping > 0) A.diagonal().array() += damping * A.trace() / static_cast<double>(A.rows());
  return x0 + JW.transpose() * solve_symmetric(A, Eigen::VectorXd(u - J * x0));
}

}  // namespace ayumi
