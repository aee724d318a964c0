#pragma once
// The bounded solution of (14)(15) for a given ZMP: the only solution of x'' = w2 (x - z) that does
// not diverge, computed as a boundary value problem on a uniform grid.

#include <Eigen/Core>
#include <array>

namespace ayumi {

/// The x [m] of x'' = w2 (x - z) with x = z at both ends, by Numerov's rule (error h^4) and one
/// tridiagonal solve. The ZMP z [m] and w2 > 0 [1/s^2] have one entry for each grid point, at least
/// 3; h is the distance of the points [s].
Eigen::VectorXd bounded_cog(const Eigen::VectorXd& z, const Eigen::VectorXd& w2, double h);

/// Bump of the ZMP near t = 0 that allows a start from rest: (w t)^2 exp(-w t) (1 - t/T)^2.
double rest_bump(double omega, double t, double duration);

/// A bounded solution that also has x' = 0 at both ends.
struct RestToRest {
  Eigen::VectorXd x;
  double begin = 0, end = 0;  ///< factors of the bumps that are added to z at the two ends
};

/// Finds such solutions for several ZMPs. A bounded motion anticipates: it moves at t = 0 when the
/// ZMP moves soon afterwards. The ZMP is therefore changed by
///   begin * bump(t) + end * bump(T - t),
/// which is close to the smallest possible change, and zero where the ZMP rests long enough at both
/// ends.
class RestToRestSolver {
 public:
  /// Takes the arguments of bounded_cog() without z. Everything that does not depend on z is
  /// computed once.
  RestToRestSolver(Eigen::VectorXd w2, double h);
  RestToRest solve(const Eigen::VectorXd& z) const;

 private:
  Eigen::Vector2d unrest(const Eigen::VectorXd& x, const Eigen::VectorXd& z) const;

  Eigen::VectorXd w2_;
  double h_;
  std::array<Eigen::VectorXd, 2> response_;  // responses of x to the bumps at both ends
  Eigen::Matrix2d unrest_;                   // unrest() of these responses
};

}  // namespace ayumi
