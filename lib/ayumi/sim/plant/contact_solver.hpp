#pragma once
// The contact problem of one step: impulses that keep points from penetrating the ground, with
// exact Coulomb cones. docs/theory_plant.md, (P3).

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"

namespace ayumi {

struct ContactSolution {
  int iterations = 0;   ///< number of sweeps and Newton steps
  double residual = 0;  ///< largest change of a shifted velocity in the last sweep or test [m/s]
};

/// The solver stops when a sweep or a test changes no shifted velocity by more than this [m/s].
/// Chosen: over a walk of 10 s, errors of this size add up to 1 nm. Between half and twice the
/// value, figures change by less than 5 %.
constexpr double kContactTolerance = 1e-10;
/// Number of sweeps after which the solver stops and reports its residual. Chosen: 300 random
/// problems of up to eight contacts (contact_solver_test) converge with fewer. No measured case
/// changes between half and twice the value (constants.md).
constexpr int kMaxContactSweeps = 500;

/// Smallest relative distance from the cone with which an impulse counts as inside it. Chosen: far
/// above the rounding at which the equation of a slide is solved, so that an impulse on the cone is
/// not inside it. No measured case changes between half and twice the value (constants.md).
constexpr double kConeMargin = 1e-9;

/// Whether the impulse of a closed contact is inside the cone by more than rounding.
inline bool inside_cone(const Eigen::Vector3d& l, double mu) {
  const double most = mu * l[0] * (1 - kConeMargin);
  return l.tail<2>().squaredNorm() < most * most;
}

/// For each contact i (rows 3i..3i+2: normal, tangent 1, tangent 2) the impulse l [N s] and the
/// shifted velocity u = A l + b [m/s] obey
///   0 <= u_n  perpendicular to  l_n >= 0,
///   |l_t| <= mu l_n;  u_t = 0 where the inequality is strict, else l_t = -s u_t with s >= 0.
/// A is the Delassus matrix with the compliance of each contact added on its diagonal (symmetric
/// positive definite), so the solution does not depend on how many points share a load.
///
/// Block Gauss-Seidel sweeps with the exact solution of each 3x3 contact, accelerated by Newton
/// steps on all closed contacts. It keeps its workspace and allocates nothing after its largest
/// problem.
class ContactSolver {
 public:
  /// Reserves memory for n contacts. The matrices and vectors below have 3n rows until the next
  /// resize().
  void resize(int n);

  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  using Vector = Eigen::Map<Eigen::VectorXd>;
  int size() const { return n_; }
  /// Matrix of 3n x 3n [1/kg].
  Matrix A() { return Matrix(store_[0].data(), 3 * n_, 3 * n_); }
  /// Vector of 3n entries [m/s].
  Vector b() { return Vector(store_[1].data(), 3 * n_); }
  /// Initial guess, and then the solution [N s].
  Vector impulse() { return Vector(store_[2].data(), 3 * n_); }
  Eigen::Map<const Eigen::VectorXd> impulse() const { return {store_[2].data(), 3 * n_}; }
  std::vector<double>& friction() { return friction_; }  ///< coefficient of each contact
  const std::vector<double>& friction() const { return friction_; }

  ContactSolution solve(double tolerance = kContactTolerance,
                        int max_iterations = kMaxContactSweeps);

 private:
  double sweep(Vector impulse, double share = 1.0);
  double correct(Vector impulse, double tolerance);
  double newton_alone(int& sweeps, double tolerance);
  bool newton_step();
  bool stick_together(int rows);
  bool stick_and_slide(int rows);
  bool sticks(int i, const Eigen::Vector3d& l, const Eigen::Vector3d& u) const;

  const kernels::Kernels* kernels_ = &kernels::best_kernels();
  int n_ = 0;
  // The vectors A, b, impulse, candidate, Newton matrix, Newton right side, velocities, first
  // impulse.
  std::array<std::vector<double>, 8> store_;
  std::vector<double> friction_;
  std::vector<int> closed_;
};

}  // namespace ayumi
