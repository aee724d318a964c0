// min 1/2 u'u + 1/2 l |D(x + u)|^2 with |u| <= 1, in units of the band, by a primal-dual interior
// point method: with slacks s = 1 -+ u and multipliers z, s z = mu,
//   (I + l D'D + z1/s1 + z2/s2) du = -(u + l D'D(x + u)) + mu (1/s2 - 1/s1),
// whose matrix has three bands on either side: the time of a step is linear in the samples.
#include "ayumi/math/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Diagonals on either side of the main one. Derived: the order of the differences.
constexpr int kBand = 3;
/// Largest number of steps of the interior point method. Chosen: the method usually takes 20.
constexpr int kSteps = 60;
/// Complementarity at which the method ends, relative to its initial value. Chosen: about
/// the square root of the rounding of double precision.
constexpr double kEnd = 1e-8;
/// Fraction of the distance to the boundary that a step covers. Chosen: below 1, so that slacks
/// stay positive, as usual for such methods.
constexpr double kToBoundary = 0.99;

using Bands =
    std::array<VectorXd, kBand + 1>;  // diagonals of a symmetric matrix, from the main one

// The matrix D'D, where D takes third differences.
Bands third_differences(Index n) {
  constexpr std::array<double, 4> d = {-1, 3, -3, 1};
  Bands P;
  for (VectorXd& diagonal : P) diagonal = VectorXd::Zero(n);
  for (Index row = 0; row + kBand < n; ++row)
    for (int i = 0; i <= kBand; ++i)
      for (int j = i; j <= kBand; ++j) P[j - i][row + i] += d[i] * d[j];
  return P;
}

VectorXd times(const Bands& P, const VectorXd& x) {
  VectorXd y = P[0].cwiseProduct(x);
  for (int b = 1; b <= kBand; ++b)
    for (Index i = 0; i + b < x.size(); ++i) {
      y[i] += P[b][i] * x[i + b];
      y[i + b] += P[b][i] * x[i];
    }
  return y;
}

// Factorises P into L D L' in place, and then solves. P is positive definite.
VectorXd solved(Bands P, VectorXd b) {
  const Index n = b.size();
  for (Index k = 0; k < n; ++k) {
    std::array<double, kBand + 1> column;
    for (int i = 1; i <= kBand; ++i) column[i] = k + i < n ? P[i][k] / P[0][k] : 0;
    for (int i = 1; i <= kBand && k + i < n; ++i) {
      for (int j = i; j <= kBand && k + j < n; ++j) P[j - i][k + i] -= column[i] * P[j][k];
      b[k + i] -= column[i] * b[k];
    }
    for (int i = 1; i <= kBand; ++i) P[i][k] = column[i];
  }
  for (Index k = n - 1; k >= 0; --k) {
    b[k] /= P[0][k];
    for (int i = 1; i <= kBand && k + i < n; ++i) b[k] -= P[i][k] * b[k + i];
  }
  return b;
}

// Largest fraction of a step after which all of v is positive.
double step_share(const VectorXd& v, const VectorXd& step) {
  double share = 1;
  for (Index i = 0; i < v.size(); ++i)
    if (step[i] < 0) share = std::min(share, -kToBoundary * v[i] / step[i]);
  return share;
}

// Returns the change u of x; both are in units of the band.
VectorXd within_one(const VectorXd& x, double weight) {
  const Index n = x.size();
  Bands P = third_differences(n);
  for (VectorXd& diagonal : P) diagonal *= weight;
  const VectorXd Px = times(P, x);
  P[0].array() += 1;
  VectorXd u = solved(P, -Px);
  if (u.cwiseAbs().maxCoeff() <= 1) return u;
  u = u.cwiseMax(-0.5).cwiseMin(0.5);
  const double scale = std::max(1.0, Px.cwiseAbs().maxCoeff());
  VectorXd z1 = VectorXd::Constant(n, scale), z2 = z1;
  for (int step = 0; step < kSteps; ++step) {
    const VectorXd s1 = 1 - u.array(), s2 = 1 + u.array();
    const double gap = (s1.dot(z1) + s2.dot(z2)) / (2.0 * static_cast<double>(n));
    if (gap < kEnd * scale) break;
    const double mu = 0.1 * gap;
    Bands A = P;
    A[0] += z1.cwiseQuotient(s1) + z2.cwiseQuotient(s2);
    const VectorXd du =
        solved(A, -(times(P, u) + Px) + mu * (s2.cwiseInverse() - s1.cwiseInverse()));
    const VectorXd dz1 = (mu + z1.array() * du.array()) / s1.array() - z1.array();
    const VectorXd dz2 = (mu - z2.array() * du.array()) / s2.array() - z2.array();
    const double share = std::min(
        {step_share(s1, -du), step_share(s2, du), step_share(z1, dz1), step_share(z2, dz2)});
    u += share * du;
    z1 += share * dz1;
    z2 += share * dz2;
  }
  return u;
}

}  // namespace

VectorXd smoothed_within(const VectorXd& x, double band, double cutoff) {
  // Smallest number of samples that are smoothed. Chosen: 2 kBand + 2; fewer samples have hardly a
  // third difference.
  constexpr Index kLeast = 8;
  if (x.size() < kLeast || !(band > 0) || x.maxCoeff() == x.minCoeff()) return x;
  const VectorXd scaled = (x.array() - x[0]) / band;
  const double weight = 1 / elementary::power<6>(2 * EIGEN_PI * cutoff);
  return x + band * within_one(scaled, weight);
}

}  // namespace ayumi
