#pragma once
// A nonlinear program as plain data and functions, and its solution by Ipopt (interior point,
// filter line search; all options are set in code):
//   min f(x)   lower <= x <= upper,   constraint_lower <= g(x) <= constraint_upper
// Linear systems are solved by banded_kkt_solver.hpp, which Ipopt knows as MA27; that file explains
// what this means for a host program that uses Ipopt itself. Programs with equality constraints,
// and all programs of a host that has its own MA27, use MUMPS.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

/// Bounds at or beyond this mean that there is no bound. Source: Ipopt's option
/// nlp_upper_bound_inf.
inline constexpr double kNoBound = 1e19;

/// The places of the nonzeros of a sparse matrix; the values have the same order. For a Hessian,
/// only the lower triangle is given.
struct SparsePattern {
  std::vector<int> rows, columns;
  int size() const { return static_cast<int>(rows.size()); }
  void add(int row, int column) {
    rows.push_back(row);
    columns.push_back(column);
  }
};

struct Nlp {
  Eigen::VectorXd start, lower, upper;  ///< start and bounds of the variables
  Eigen::VectorXd constraint_lower, constraint_upper;
  /// Multipliers of the constraints near the solution if they are known, otherwise empty. The
  /// multipliers of the variables' bounds follow from the gradient.
  Eigen::VectorXd start_multipliers;
  SparsePattern jacobian, hessian;

  std::function<double(const Eigen::VectorXd& x)> objective;
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)> gradient;
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& values)> constraints;
  /// Computes the values of dg/dx in the order of `jacobian`.
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& values)> jacobian_values;
  /// Computes the values of scale * d2f/dx2 + sum multipliers_i * d2g_i/dx2 in the order of
  /// `hessian`; a positive semidefinite approximation is allowed (Gauss-Newton).
  std::function<void(const Eigen::VectorXd& x, double scale, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& values)>
      hessian_values;
};

/// The largest violation of a constraint by the start; negative if the start is inside all
/// constraints.
double violation_at_start(const Nlp& nlp);

struct NlpOptions {
  int max_iterations = repair_policy::rounds::kMostIterations;
  /// Tolerance of the optimality conditions. A value below the default only applies to
  /// complementarity, which determines how far the limits push the solution away. The tolerance of
  /// the gradient is the default.
  double tolerance = repair_policy::solver::kTolerance;
  /// Initial barrier, and distance to which the start is pushed from its bounds; both are smaller
  /// for a warm start.
  double start_barrier = repair_policy::solver::kStartBarrier;
  double start_push = repair_policy::solver::kStartPush;
  /// Tolerance of g, unscaled.
  double constraint_tolerance = repair_policy::solver::kConstraintTolerance;
  /// Distances of bodies have kinks, where Newton's steps may alternate between two points without
  /// end. If this is above 0, the solution ends with the status solved after several iterations in
  /// turn that keep all constraints and hardly change the objective: by less than this share of it,
  /// or of 1 if the objective is smaller.
  double still_change = 0;
  /// Largest complementarity with which such a search ends.
  double still_complementarity = repair_policy::solver::kKinkGradient;
  bool mumps = false;  ///< use MUMPS for the linear systems of every program
  /// Solves linear systems without the widest vector instructions; the bits are the same.
  bool plain_kernels = false;
  /// The solution ends with the status iteration_limit when its work reaches this.
  double most_work = kNoBound;
  /// If not null, the point with the smallest violation is stored here, for work that is stopped.
  Eigen::VectorXd* least_violating = nullptr;
};

enum class NlpStatus { solved, infeasible, iteration_limit, failed };

struct NlpSolution {
  NlpStatus status = NlpStatus::failed;
  bool out_of_work = false;  ///< whether the work, and not the iterations, reached its limit
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;  ///< multipliers of the constraints
  int iterations = 0;
  double objective = 0;
  double violation = 0;  ///< largest violation of a constraint or bound
  /// Evaluations and iterations, each multiplied by the number of nonzeros and the work for each of
  /// them. The number is the same for the same program, on every machine and for any number of
  /// threads.
  double work = 0;
  double function_seconds = 0;  ///< processor time in the functions of the program
  double solver_seconds = 0;    ///< processor time in Ipopt itself
};

/// Throws Interrupted if `progress` stops the work. `stage` names the work for `progress`.
NlpSolution solve(const Nlp& nlp, const NlpOptions& options = {}, const Progress& progress = {},
                  const std::string& stage = "solve");

}  // namespace ayumi
