#include "ayumi/math/weighted_solve.hpp"

#include <cmath>

namespace ayumi {

namespace {

constexpr int kRows = BodyTasks::kRows;
constexpr double kSmallestPivot = 1e-13;  // of the largest diagonal entry

using Square = Eigen::Matrix<double, kRows, kRows>;

// J W^-1 J', damped; the lower triangle.
void task_matrix(const BodyTasks& tasks, const Eigen::VectorXd& w, double damping, Square& A) {
  A.setZero();
  for (Eigen::Index j = 0; j < tasks.J.cols(); ++j) {
    const double* column = tasks.J.data() + kRows * j;
    const int lead = tasks.lead[static_cast<size_t>(j)];
    const double inverse = 1 / w[j];
    for (int k = 0; k < lead; ++k) {
      const double factor = inverse * column[k];
      double* to = A.data() + kRows * k;
      for (int i = k; i < lead; ++i) to[i] += factor * column[i];
    }
  }
  if (damping > 0) A.diagonal().array() += damping * A.trace() / kRows;
}

// y <- A^-1 y by Cholesky in the lower triangle of A; false, y untouched, where A is not safely
// positive.
bool solve_positive(Square& A, BodyTasks::Vector& y) {
  const double least = kSmallestPivot * A.diagonal().maxCoeff();
  BodyTasks::Vector inverse;
  for (int k = 0; k < kRows; ++k) {
    double* of_k = A.data() + kRows * k;
    for (int j = 0; j < k; ++j) {
      const double* of_j = A.data() + kRows * j;
      const double factor = of_j[k];
      for (int i = k; i < kRows; ++i) of_k[i] -= factor * of_j[i];
    }
    if (!(of_k[k] > least)) return false;
    inverse[k] = 1 / std::sqrt(of_k[k]);
    for (int i = k; i < kRows; ++i) of_k[i] *= inverse[k];
  }
  for (int k = 0; k < kRows; ++k) {
    const double* of_k = A.data() + kRows * k;
    y[k] *= inverse[k];
    for (int i = k + 1; i < kRows; ++i) y[i] -= of_k[i] * y[k];
  }
  for (int k = kRows - 1; k >= 0; --k) {
    const double* of_k = A.data() + kRows * k;
    for (int i = k + 1; i < kRows; ++i) y[k] -= of_k[i] * y[i];
    y[k] *= inverse[k];
  }
  return true;
}

}  // namespace

Eigen::VectorXd weighted_least_norm(const Eigen::MatrixXd& J, const Eigen::VectorXd& u,
                                    const Eigen::VectorXd& w, const Eigen::VectorXd& x0,
                                    double damping) {
  const Eigen::MatrixXd JW = J * w.cwiseInverse().asDiagonal();
  // Task and joints are few: the plain product is ahead of the blocked one.
  Eigen::MatrixXd A = JW.lazyProduct(J.transpose());
  if (damping > 0) A.diagonal().array() += damping * A.trace() / static_cast<double>(A.rows());
  return x0 + JW.transpose() * A.ldlt().solve(u - J * x0);
}

void weighted_least_norm(const BodyTasks& tasks, const Eigen::VectorXd& w,
                         const Eigen::VectorXd& x0, double damping, Eigen::VectorXd& x) {
  BodyTasks::Vector y = tasks.u;
  for (Eigen::Index j = 0; j < tasks.J.cols(); ++j)
    for (int i = 0; i < tasks.lead[static_cast<size_t>(j)]; ++i) y[i] -= tasks.J(i, j) * x0[j];
  Square A;
  task_matrix(tasks, w, damping, A);
  if (!solve_positive(A, y)) {  // tasks that contradict each other, undamped
    x = weighted_least_norm(tasks.J, tasks.u, w, x0, damping);
    return;
  }
  x = x0;
  for (Eigen::Index j = 0; j < tasks.J.cols(); ++j) {
    double sum = 0;
    for (int i = 0; i < tasks.lead[static_cast<size_t>(j)]; ++i) sum += tasks.J(i, j) * y[i];
    x[j] += sum / w[j];
  }
}

}  // namespace ayumi
