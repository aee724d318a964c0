#pragma once
// A nonlinear program as plain data and functions, and its solution by Ipopt (interior point,
// filter line search; all options are set in code). Linear systems by condensed_solver.hpp, with
// equality constraints by MUMPS.
//   min f(x)   lower <= x <= upper,   constraint_lower <= g(x) <= constraint_upper

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "ayumi/base/progress.hpp"

namespace ayumi {

/// Bounds at or beyond this mean "none".
inline constexpr double kNoBound = 1e19;

/// Where the nonzeros of a sparse matrix are; the values come in the same order. Of the Hessian
/// only the lower triangle.
struct SparsePattern {
  std::vector<int> rows, columns;
  int size() const { return static_cast<int>(rows.size()); }
  void add(int row, int column) {
    rows.push_back(row);
    columns.push_back(column);
  }
};

struct Nlp {
  Eigen::VectorXd start, lower, upper;  ///< variables
  Eigen::VectorXd constraint_lower, constraint_upper;
  SparsePattern jacobian, hessian;

  std::function<double(const Eigen::VectorXd& x)> objective;
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)> gradient;
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& values)> constraints;
  /// Values of dg/dx in the order of `jacobian`.
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& values)> jacobian_values;
  /// Values of scale * d2f/dx2 + sum multipliers_i * d2g_i/dx2 in the order of `hessian`; a
  /// positive semidefinite approximation is allowed (Gauss-Newton).
  std::function<void(const Eigen::VectorXd& x, double scale, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& values)>
      hessian_values;
};

/// The most by which the start breaks a constraint; negative inside all.
double violation_at_start(const Nlp& nlp);

struct NlpOptions {
  int max_iterations = 100;
  double tolerance = 1e-6;             ///< of the optimality conditions
  double start_barrier = 1e-3;         ///< smaller from a start that is nearly right
  double start_push = 1e-2;            ///< of a start off its bounds; likewise
  double constraint_tolerance = 1e-7;  ///< of g, unscaled
  bool mumps = false;                  ///< for the linear systems of any program
  /// Kept up to date with the point of least violation seen, for work that is stopped.
  Eigen::VectorXd* least_violating = nullptr;
};

enum class NlpStatus { solved, infeasible, iteration_limit, failed };

struct NlpSolution {
  NlpStatus status = NlpStatus::failed;
  Eigen::VectorXd x;
  int iterations = 0;
  double objective = 0;
  double violation = 0;                             ///< largest of any constraint or bound
  double function_seconds = 0, solver_seconds = 0;  ///< of processor, in functions; in the rest
};

/// Throws Interrupted when `progress` stops the work. `stage` names the work to `progress`.
NlpSolution solve(const Nlp& nlp, const NlpOptions& options = {}, const Progress& progress = {},
                  const std::string& stage = "solve");

}  // namespace ayumi
