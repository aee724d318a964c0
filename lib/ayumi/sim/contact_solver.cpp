// One contact alone, D = its diagonal block, r = what the others leave (b + off-diagonal A l):
//   open:   r_n >= 0                       -> l = 0
//   stick:  l = -D^-1 r, inside the cone   -> l
//   slide:  u_n = 0, (D_tt + s 1) l_t + D_tn l_n + r_t = 0 with the s >= 0 that puts l on the cone.
// The slide is one equation in s: |l_t(s)| - mu l_n(s) falls with s; safeguarded Newton.
#include "ayumi/sim/contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// l_n from u_n = 0 given l_t; then the tangential rows hold the reduced matrix K = D_tt - D_tn
// D_nt / D_nn and right side c.
Vector3d slide(const Matrix3d& D, const Vector3d& r, double mu) {
  const double dnn = D(0, 0);
  const Vector2d dtn = D.block<2, 1>(1, 0);
  const Matrix2d K = D.block<2, 2>(1, 1) - dtn * dtn.transpose() / dnn;
  const Vector2d c = r.tail<2>() - dtn * (r[0] / dnn);
  auto at = [&](double s) {
    Matrix2d m = K;
    m.diagonal().array() += s;
    const Vector2d t = -m.inverse() * c;
    return Vector3d(-(r[0] + dtn.dot(t)) / dnn, t.x(), t.y());
  };
  auto excess = [&](const Vector3d& l) { return l.tail<2>().norm() - mu * l[0]; };
  double low = 0, high = K.trace();
  for (int i = 0; i < 60 && excess(at(high)) > 0; ++i) {
    low = high;
    high *= 4;
  }
  // Illinois false position: bracketing, superlinear, no derivatives.
  double f_low = excess(at(low)), f_high = excess(at(high));
  Vector3d l = at(high);
  for (int i = 0; i < 60; ++i) {
    const double s = (low * f_high - high * f_low) / (f_high - f_low);
    if (!(s > low && s < high)) break;
    l = at(s);
    const double f = excess(l);
    if (std::abs(f) <= 1e-14 * (mu * std::abs(l[0]) + 1e-12)) break;
    if (f > 0) {
      low = s;
      f_low = f;
      f_high *= 0.5;
    } else {
      high = s;
      f_high = f;
      f_low *= 0.5;
    }
  }
  const double t = l.tail<2>().norm();
  if (l[0] <= 0) return Vector3d::Zero();
  if (t > 0) l.tail<2>() *= mu * l[0] / t;
  return l;
}

Vector3d solve_one(const Matrix3d& D, const Vector3d& r, double mu) {
  if (r[0] >= 0) return Vector3d::Zero();
  if (mu <= 0) return {-r[0] / D(0, 0), 0, 0};
  const Vector3d stick = -D.llt().solve(r);
  if (stick[0] >= 0 && stick.tail<2>().norm() <= mu * stick[0]) return stick;
  return slide(D, r, mu);
}

}  // namespace

ContactSolution solve_contacts(const ContactProblem& problem, Eigen::VectorXd& impulse,
                               double tolerance, int max_iterations) {
  ContactSolution result;
  const int n = static_cast<int>(problem.friction.size());
  if (n == 0) return result;
  for (int sweep = 1; sweep <= max_iterations; ++sweep) {
    double change = 0;
    for (int i = 0; i < n; ++i) {
      const auto rows = problem.A.middleCols<3>(3 * i);  // symmetric: columns are contiguous
      const Matrix3d D = rows.middleRows<3>(3 * i);
      const Vector3d old = impulse.segment<3>(3 * i);
      const Vector3d r =
          rows.transpose() * impulse + problem.b.segment<3>(3 * i) - D * old;
      const Vector3d next = solve_one(D, r, problem.friction[i]);
      change = std::max(change, (D * (next - old)).cwiseAbs().maxCoeff());
      impulse.segment<3>(3 * i) = next;
    }
    result.iterations = sweep;
    result.residual = change;
    if (change <= tolerance) break;
  }
  return result;
}

}  // namespace ayumi
