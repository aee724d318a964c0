// Numerov: x_{k+1} - 2 x_k + x_{k-1} = h^2/12 (f_{k+1} + 10 f_k + f_{k-1}), f = w2 (x - z). The
// rest before the start means x_{-1} = x_0 and f_{-1} = f_0 = 0: x_1 - x_0 - h^2/12 f_1 = 0. For a
// start from rest, the initial DCM w int e^{-wt} z dt has to equal z_0. A bump b(t) shifts the DCM
// by w int e^{-wt} b dt. The smallest bump for a given shift is b ~ e^{-wt}; (wt)^2 e^{-wt} is 8 %
// larger and starts smoothly.
#include "ayumi/math/bounded_curve.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::VectorXd;

VectorXd bounded_cog(const VectorXd& z, const VectorXd& w2, double h) {
  const Eigen::Index n = z.size() - 1;
  require(n >= 2 && w2.size() == n + 1, "bounded_cog: at least three points");
  const VectorXd c = h * h / 12.0 * w2;
  VectorXd x(n + 1), upper = VectorXd::Zero(n + 1);
  x[0] = z[0];
  for (Eigen::Index k = 1; k < n; ++k) {
    const double lower = 1 - c[k - 1], diagonal = -2 - 10 * c[k], next = 1 - c[k + 1];
    const double right = -c[k - 1] * z[k - 1] - 10 * c[k] * z[k] - c[k + 1] * z[k + 1];
    const double pivot = diagonal - lower * upper[k - 1];
    upper[k] = next / pivot;
    x[k] = (right - lower * x[k - 1]) / pivot;
  }
  x[n] = z[n];
  for (Eigen::Index k = n - 1; k >= 1; --k) x[k] -= upper[k] * x[k + 1];
  return x;
}

double rest_bump(double omega, double t, double duration) {
  if (t <= 0 || t >= duration) return 0;
  const double u = omega * t, fade = 1 - t / duration;
  return u * u * elementary::exp(-u) * fade * fade;
}

RestToRestSolver::RestToRestSolver(VectorXd w2, double h) : w2_(std::move(w2)), h_(h) {
  const Eigen::Index n = w2_.size() - 1;
  const double duration = h * static_cast<double>(n);
  std::array<VectorXd, 2> bump = {VectorXd(n + 1), VectorXd(n + 1)};
  for (Eigen::Index k = 0; k <= n; ++k) {
    const double t = h * static_cast<double>(k);
    bump[0][k] = rest_bump(std::sqrt(w2_[0]), t, duration);
    bump[1][k] = rest_bump(std::sqrt(w2_[n]), duration - t, duration);
  }
  for (size_t i = 0; i < 2; ++i) response_[i] = bounded_cog(bump[i], w2_, h);
  unrest_ << unrest(response_[0], bump[0]), unrest(response_[1], bump[1]);
}

// The deviation of x from rest at both ends, for a ZMP z.
Eigen::Vector2d RestToRestSolver::unrest(const VectorXd& x, const VectorXd& z) const {
  const auto at = [&](Eigen::Index end, Eigen::Index inner) {
    return x[inner] - x[end] - h_ * h_ / 12.0 * w2_[inner] * (x[inner] - z[inner]);
  };
  const Eigen::Index n = w2_.size() - 1;
  return {at(0, 1), at(n, n - 1)};
}

RestToRest RestToRestSolver::solve(const VectorXd& z) const {
  RestToRest result;
  result.x = bounded_cog(z, w2_, h_);
  const Eigen::Vector2d factor = -unrest_.partialPivLu().solve(unrest(result.x, z));
  result.begin = factor[0];
  result.end = factor[1];
  result.x += factor[0] * response_[0] + factor[1] * response_[1];
  return result;
}

}  // namespace ayumi
