#pragma once
// The tasks of the whole body and their weighted least-norm solve, twelve rows at once.

#include <Eigen/Dense>

namespace ayumi {

/// Twelve rows of tasks by joint rates.
struct BodyTasks {
  static constexpr int kRows = 12;
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Rows = Eigen::Matrix<double, kRows, Eigen::Dynamic>;
  Rows J;
  Vector u;
};

/// weighted_least_norm() of math/weighted_solve.hpp for these, into x; `weighted` is room to work
/// in. Allocates nothing when both have their size.
void solve_tasks(const BodyTasks& tasks, const Eigen::VectorXd& w, const Eigen::VectorXd& x0,
                 double damping, BodyTasks::Rows& weighted, Eigen::VectorXd& x);

}  // namespace ayumi
