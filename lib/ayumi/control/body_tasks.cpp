#include "ayumi/control/body_tasks.hpp"

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/math/weighted_solve.hpp"

namespace ayumi {

void solve_tasks(const BodyTasks& tasks, const Eigen::VectorXd& w, const Eigen::VectorXd& x0,
                 double damping, BodyTasks::Rows& weighted, Eigen::VectorXd& x) {
  constexpr int kRows = BodyTasks::kRows;
  const kernels::Kernels& kernels = kernels::best_kernels();
  const int n = static_cast<int>(tasks.J.cols());
  weighted.resize(kRows, n);
  for (int j = 0; j < n; ++j) weighted.col(j) = tasks.J.col(j) * (1 / w[j]);
  Eigen::Matrix<double, kRows, kRows> A;
  kernels.gram(weighted.data(), kRows, tasks.J.data(), kRows, n, kRows, kRows, A.data(), kRows);
  if (damping > 0) A.diagonal().array() += damping * A.trace() / kRows;
  BodyTasks::Vector y = -tasks.u;
  kernels.multiply_add(tasks.J.data(), kRows, n, kRows, x0.data(), y.data());
  if (!kernels.solve_positive(A.data(), kRows, kRows, y.data())) {
    x = weighted_least_norm(tasks.J, tasks.u, w, x0, damping);  // tasks that contradict each other
    return;
  }
  x = x0;
  for (int j = 0; j < n; ++j) x[j] -= weighted.col(j).dot(y);
}

}  // namespace ayumi
