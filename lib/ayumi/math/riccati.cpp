// Structure-preserving doubling: with G = B R^-1 B', H = Q at first,
//   A <- A W A,  G <- G + A W G A',  H <- H + A' H W A,  W = (I + G H)^-1,
// H is the cost of 1, 2, 4, ... steps, and converges to P quadratically (Chu, Fan, Lin, Wang 2004).
#include "ayumi/math/riccati.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

using Eigen::MatrixXd;

namespace {

// Largest number of doublings; if they are not enough, there is no solution. Chosen: 2^40 steps are
// longer than any motion, and so are 2^20; the regulators here need about twelve doublings.
constexpr int kMostDoublings = 40;

// Change of the cost in a doubling, relative to the cost, below which the cost is the solution.
// Chosen: a few hundred times the rounding of double precision. Since the change is squared in
// every doubling, half or twice the value makes at most one doubling more or less.
constexpr double kConverged = 1e-13;

}  // namespace

MatrixXd solve_riccati(const MatrixXd& A0, const MatrixXd& B, const MatrixXd& Q,
                       const MatrixXd& R) {
  MatrixXd A = A0, G = B * solve_symmetric(R, MatrixXd(B.transpose())), H = Q;
  const MatrixXd one = MatrixXd::Identity(A.rows(), A.cols());
  for (int i = 0; i < kMostDoublings; ++i) {
    const MatrixXd W = one + G * H;
    const MatrixXd WA = solve_general(W, A), WG = solve_general(W, G);
    const MatrixXd change = A.transpose() * H * WA;
    G += A * WG * A.transpose();
    A = A * WA;
    H += 0.5 * (change + change.transpose());
    if (!H.allFinite()) break;
    if (change.cwiseAbs().maxCoeff() <= kConverged * H.cwiseAbs().maxCoeff()) return H;
  }
  fail(ErrorCode::internal, "the Riccati equation has no stabilizing solution");
}

MatrixXd regulator_gain(const MatrixXd& A, const MatrixXd& B, const MatrixXd& R,
                        const MatrixXd& P) {
  const MatrixXd BP = B.transpose() * P;
  return solve_symmetric(MatrixXd(R + BP * B), MatrixXd(BP * A));
}

}  // namespace ayumi
