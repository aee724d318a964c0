#pragma once
// The contact problem of one time step: impulses that keep points from sinking in, with exact
// Coulomb cones. docs/theory.md, "Contact and servo integration".

#include <Eigen/Dense>
#include <vector>

namespace ayumi {

/// For contact i (rows 3i..3i+2: normal, tangent 1, tangent 2) find the impulse l and the shifted
/// velocity u = A l + b with
///   0 <= u_n  perpendicular to  l_n >= 0,
///   |l_t| <= mu l_n;  u_t = 0 where the inequality is strict, else l_t = -s u_t with s >= 0.
/// A is the Delassus matrix with the compliance of each contact added on its diagonal (symmetric
/// positive definite), so the solution does not depend on how many points share a load.
struct ContactProblem {
  Eigen::MatrixXd A;           ///< 3n x 3n [1/kg]
  Eigen::VectorXd b;           ///< 3n [m/s]
  std::vector<double> friction;  ///< n
};

struct ContactSolution {
  int iterations = 0;   ///< sweeps
  double residual = 0;  ///< largest change of a shifted velocity in the last sweep [m/s]
};

/// Block Gauss-Seidel with the exact solution of each 3x3 contact, sped up by Newton steps on all
/// closed contacts; started from `impulse` (3n), which receives the answer [N s]. Stops when a sweep
/// changes no shifted velocity by more than `tolerance` [m/s].
ContactSolution solve_contacts(const ContactProblem& problem, Eigen::VectorXd& impulse,
                               double tolerance = 1e-10, int max_iterations = 500);

}  // namespace ayumi
