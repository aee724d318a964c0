// For one contact alone, with D its diagonal block and r = b + the off-diagonal part of A l:
//   open:   r_n >= 0                       -> l = 0
//   stick:  l = -D^-1 r, inside the cone   -> l
//   slide:  u_n = 0, (D_tt + s 1) l_t + D_tn l_n + r_t = 0 with the s >= 0 that puts l on the cone.
// The slide is one equation in s: |l_t(s)| - mu l_n(s) falls with s.
// Sweeps find which contacts are open, stick or slide. One Newton step on all closed contacts,
//   stick: u = 0        slide: u_n = 0, l_t + mu l_n u_t/|u_t| = 0,
// then arrives at the solution, where sweeps alone converge slowly when many points share a stiff
// load. A Newton step is kept only when the sweep after it changes less than the sweep before it.
// Newton steps from the last step's impulses come first, as long as they approach the solution: the
// first one is usually the solution. A test of each contact against the others shows this for the
// cost of one product with A.
#include "ayumi/sim/plant/contact_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ayumi {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Limits of the rounding of double precision (1.1e-16). They only decide when an iteration ends or
// which formula is used next to the cone; the solver's tolerance decides the result.

/// Relative distance from the cone at which the equation of a slide is solved. Chosen: 100 times
/// the rounding. Between half and twice the value, figures change by less than 5 %.
constexpr double kConeRounding = 1e-14;
/// Impulse that is added to mu l_n in this equation, so that the limit is not 0 for an open contact
/// [N s]. Chosen: 1e-9 of the impulse of a weight of 1 N in a step of 1 ms. No measured case
/// changes between half and twice the value (constants.md).
constexpr double kNoImpulse = 1e-12;
/// Tangential speed below which a contact on the cone sticks, where the direction of the slip is
/// lost to rounding [m/s]. Chosen: 1/100 of kContactTolerance. No measured case changes between
/// half and twice the value (constants.md).
constexpr double kNoSlip = 1e-12;
/// Largest number of steps for the equation of a slide. Chosen: bisection of a bracket alone takes
/// 60. No measured case changes between half and twice the value (constants.md).
constexpr int kMaxSlideSteps = 100;

// u_n = 0 gives l_n as a function of l_t. The tangential rows then have the reduced matrix
// K = D_tt - D_tn D_nt / D_nn and the right side c. Newton's method within a bracket solves
// 1/|l_t| - 1/(mu l_n) = 0, which is almost linear in s.
Vector3d slide(const Matrix3d& D, const Vector3d& r, double mu) {
  const double dnn = D(0, 0);
  const Vector2d dtn = D.block<2, 1>(1, 0);
  const Matrix2d K = D.block<2, 2>(1, 1) - dtn * dtn.transpose() / dnn;
  const Vector2d c = r.tail<2>() - dtn * (r[0] / dnn);
  double s = 0, low = 0, high = std::numeric_limits<double>::infinity();
  Vector3d l;
  for (int i = 0; i < kMaxSlideSteps; ++i) {
    Matrix2d m = K;
    m.diagonal().array() += s;
    const Matrix2d inverse = m.inverse();
    const Vector2d t = -inverse * c, dt = -inverse * t;
    const double n = -(r[0] + dtn.dot(t)) / dnn, dn = -dtn.dot(dt) / dnn, size = t.norm();
    l << n, t;
    const double outside = size - mu * n;  // distance outside the cone
    if (std::abs(outside) <= kConeRounding * (mu * std::abs(n) + kNoImpulse)) break;
    (outside > 0 ? low : high) = s;
    double next = low;
    if (n > 0 && size > 0)
      next = s - (1 / size - 1 / (mu * n)) / (dn / (mu * n * n) - t.dot(dt) / (size * size * size));
    if (!(next > low && next < high))
      next = high < std::numeric_limits<double>::infinity() ? 0.5 * (low + high)
                                                            : 4 * std::max(low, K.trace());
    if (next == low || next == high) break;
    s = next;
  }
  const double t = l.tail<2>().norm();
  if (l[0] <= 0) return Vector3d::Zero();
  if (t > 0) l.tail<2>() *= mu * l[0] / t;
  return l;
}

/// Computes D^-1 r for a symmetric positive definite D.
Vector3d solve_three(const Matrix3d& D, const Vector3d& r) {
  const double a = 1 / D(0, 0), l10 = a * D(1, 0), l20 = a * D(2, 0);
  const double b = 1 / (D(1, 1) - l10 * D(1, 0)), e = D(2, 1) - l20 * D(1, 0), l21 = b * e;
  const double c = 1 / (D(2, 2) - l20 * D(2, 0) - l21 * e);
  const double y1 = r[1] - l10 * r[0], y2 = r[2] - l20 * r[0] - l21 * y1;
  const double x2 = c * y2, x1 = b * y1 - l21 * x2;
  return {a * r[0] - l10 * x1 - l20 * x2, x1, x2};
}

Vector3d solve_one(const Matrix3d& D, const Vector3d& r, double mu) {
  if (r[0] >= 0) return Vector3d::Zero();
  if (mu <= 0) return {-r[0] / D(0, 0), 0, 0};
  const Vector3d stick = -solve_three(D, r);
  if (stick[0] >= 0 && stick.tail<2>().norm() <= mu * stick[0]) return stick;
  return slide(D, r, mu);
}

/// The distance of a contact with impulse l and shifted velocity u from its law [m/s].
double off_by(const Matrix3d& D, const Vector3d& l, const Vector3d& u, double mu) {
  if (l[0] > 0 && inside_cone(l, mu)) return u.cwiseAbs().maxCoeff();
  if (l.isZero(0)) return std::max(-u[0], 0.0);
  const double normal = l[0], along = l.tail<2>().norm(), speed = u.tail<2>().norm();
  if (!(normal > 0 && along > 0)) return (D * (solve_one(D, u - D * l, mu) - l)).norm();
  // u_t has to be opposite to l_t, and l has to be on the cone.
  return std::max({std::abs(u[0]), (u.tail<2>() + speed / along * l.tail<2>()).norm(),
                   D.diagonal().maxCoeff() * std::abs(along - mu * normal)});
}

/// Solves x <- G^-1 x in place by elimination with partial pivoting; G is column-major with m rows.
/// Returns false if G is singular.
bool eliminate(double* G, double* x, int m) {
  for (int k = 0; k < m; ++k) {
    int pivot = k;
    for (int i = k + 1; i < m; ++i)
      if (std::abs(G[i + m * k]) > std::abs(G[pivot + m * k])) pivot = i;
    if (!(std::abs(G[pivot + m * k]) > 0)) return false;
    if (pivot != k) {
      for (int j = k; j < m; ++j) std::swap(G[k + m * j], G[pivot + m * j]);
      std::swap(x[k], x[pivot]);
    }
    const double inverse = 1.0 / G[k + m * k];
    double* column = G + m * k;
    for (int i = k + 1; i < m; ++i) column[i] *= inverse;
    for (int j = k + 1; j < m; ++j) {
      const double factor = G[k + m * j];
      if (factor == 0) continue;
      // A column other than `column`: the two do not overlap.
      double* __restrict target = G + m * j;
      for (int i = k + 1; i < m; ++i) target[i] -= factor * column[i];
    }
    for (int i = k + 1; i < m; ++i) x[i] -= x[k] * column[i];
  }
  for (int k = m - 1; k >= 0; --k) {
    x[k] /= G[k + m * k];
    for (int i = 0; i < k; ++i) x[i] -= x[k] * G[i + m * k];
  }
  return true;
}

}  // namespace

void ContactSolver::resize(int n) {
  n_ = n;
  const size_t rows = static_cast<size_t>(3 * n);
  for (size_t k = 0; k < store_.size(); ++k) {
    const size_t size = k == 0 ? rows * rows : k == 4 ? (rows + 3) * (rows + 3) : rows + 3;
    if (store_[k].size() < size) store_[k].resize(size);
  }
  friction_.resize(static_cast<size_t>(n));
  closed_.reserve(static_cast<size_t>(n));
}

// One Gauss-Seidel sweep with the relaxation factor `share`. Returns the largest change of a
// shifted velocity that the sweep would make without relaxation.
double ContactSolver::sweep(Vector l, double share) {
  double change = 0;
  const Matrix matrix = A();
  const Vector offset = b();
  for (int i = 0; i < n_; ++i) {
    // Columns are contiguous, and the matrix is symmetric.
    const auto rows = matrix.middleCols<3>(3 * i);
    const Matrix3d D = rows.middleRows<3>(3 * i);
    const Vector3d old = l.segment<3>(3 * i);
    Vector3d r = offset.segment<3>(3 * i) - D * old;
    for (int k = 0; k < 3; ++k) r[k] += rows.col(k).dot(l);
    const Vector3d next = solve_one(D, r, friction_[i]);
    change = std::max(change, (D * (next - old)).cwiseAbs().maxCoeff());
    l.segment<3>(3 * i) = share == 1.0 ? next : Vector3d(old + share * (next - old));
  }
  return change;
}

// Tests each contact against its law while the impulses of the others are constant. A contact that
// deviates by more than `tolerance` gets the solution for itself alone. Returns the largest
// violation of a law [m/s].
double ContactSolver::correct(Vector l, double tolerance) {
  const Matrix matrix = A();
  Vector u(store_[6].data(), 3 * n_);
  u = b();
  kernels_->multiply_add(matrix.data(), 3 * n_, 3 * n_, 3 * n_, l.data(), u.data());
  double change = 0;
  for (int i = 0; i < n_; ++i) {
    const Vector3d own = l.segment<3>(3 * i), rate = u.segment<3>(3 * i);
    const Matrix3d D = matrix.block<3, 3>(3 * i, 3 * i);
    const double mu = friction_[static_cast<size_t>(i)];
    const double off = off_by(D, own, rate, mu);
    change = std::max(change, off);
    if (off > tolerance) l.segment<3>(3 * i) = solve_one(D, rate - D * own, mu);
  }
  return change;
}

/// Whether a closed contact sticks in the Newton step.
bool ContactSolver::sticks(int i, const Vector3d& l, const Vector3d& u) const {
  return inside_cone(l, friction_[static_cast<size_t>(i)]) ||
         u.tail<2>().squaredNorm() < kNoSlip * kNoSlip;
}

// One Newton step for the contacts that are closed in impulse(). Writes the candidate. Returns
// false if the matrix is singular.
bool ContactSolver::newton_step() {
  const Matrix matrix = A();
  const Vector l = impulse();
  closed_.clear();
  for (int i = 0; i < n_; ++i)
    if (l[3 * i] > 0) closed_.push_back(i);
  const int rows = 3 * static_cast<int>(closed_.size());
  Vector u(store_[6].data(), 3 * n_);
  u = b();
  bool all_stick = rows == 3 * n_;
  for (int i : closed_)
    all_stick = all_stick && inside_cone(l.segment<3>(3 * i), friction_[static_cast<size_t>(i)]);
  const bool from_zero = all_stick;  // the step solves A l = -b and does not depend on l
  if (!from_zero) {
    kernels_->multiply_add(matrix.data(), 3 * n_, 3 * n_, 3 * n_, l.data(), u.data());
    all_stick = true;
    for (int i : closed_)
      all_stick = all_stick && sticks(i, l.segment<3>(3 * i), u.segment<3>(3 * i));
  }
  const bool solved = all_stick && stick_together(rows);
  if (!solved && (from_zero || !stick_and_slide(rows))) return false;
  const Vector F(store_[5].data(), rows);
  Vector next(store_[3].data(), 3 * n_);
  if (from_zero)
    next = -F;
  else
    next = l;
  for (size_t a = 0; a < closed_.size() && !from_zero; ++a)
    next.segment<3>(3 * closed_[a]) -= F.segment<3>(3 * static_cast<int>(a));
  return next.allFinite();
}

// If all contacts stick, the matrix is that of the problem: symmetric and positive definite.
bool ContactSolver::stick_together(int rows) {
  const Matrix matrix = A();
  const int stride = (rows + 3) / 4 * 4;
  if (rows == 3 * n_) {
    for (int c = 0; c < rows; ++c)
      std::copy_n(matrix.data() + c * rows + c, rows - c, store_[4].data() + c * stride + c);
    std::copy_n(store_[6].data(), rows, store_[5].data());
    return kernels_->solve_positive(store_[4].data(), rows, stride, store_[5].data());
  }
  for (int c = 0; c < rows; ++c) {
    const auto from = matrix.col(3 * closed_[static_cast<size_t>(c / 3)] + c % 3);
    double* to = store_[4].data() + c * stride;
    for (size_t a = static_cast<size_t>(c / 3); a < closed_.size(); ++a)
      for (int k = 0; k < 3; ++k) to[3 * static_cast<int>(a) + k] = from[3 * closed_[a] + k];
    store_[5][static_cast<size_t>(c)] =
        store_[6][static_cast<size_t>(3 * closed_[static_cast<size_t>(c / 3)] + c % 3)];
  }
  return kernels_->solve_positive(store_[4].data(), rows, stride, store_[5].data());
}

bool ContactSolver::stick_and_slide(int rows) {
  const Matrix matrix = A();
  const Vector l = impulse(), u(store_[6].data(), 3 * n_);
  Matrix G(store_[4].data(), rows, rows);
  Vector F(store_[5].data(), rows);
  const int m = rows / 3;
  for (int a = 0; a < m; ++a) {
    const int i = closed_[a];
    for (int c = 0; c < m; ++c)
      G.block<3, 3>(3 * a, 3 * c) = matrix.block<3, 3>(3 * i, 3 * closed_[c]);
    F.segment<3>(3 * a) = u.segment<3>(3 * i);
    if (sticks(i, l.segment<3>(3 * i), u.segment<3>(3 * i))) continue;
    const double mu = friction_[i], normal = l[3 * i];
    const Vector2d lt = l.segment<2>(3 * i + 1), ut = u.segment<2>(3 * i + 1);
    const double speed = ut.norm();
    const Vector2d e = ut / speed;
    const Matrix2d turn = mu * normal / speed * (Matrix2d::Identity() - e * e.transpose());
    for (int column = 0; column < rows; ++column)
      G.block<2, 1>(3 * a + 1, column) = (turn * G.block<2, 1>(3 * a + 1, column)).eval();
    G.block<2, 2>(3 * a + 1, 3 * a + 1) += Matrix2d::Identity();
    G.block<2, 1>(3 * a + 1, 3 * a) += mu * e;
    F.segment<2>(3 * a + 1) = lt + mu * normal * e;
  }
  return eliminate(store_[4].data(), store_[5].data(), rows);
}

// Makes Newton steps from the last step's impulses while each one reduces the violation of the
// contact laws. Returns the remaining violation. If the steps do not reach the tolerance, restores
// the impulses and returns infinity.
double ContactSolver::newton_alone(int& sweeps, double tolerance) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Vector candidate(store_[3].data(), 3 * n_), start(store_[7].data(), 3 * n_);
  bool closed = false;
  for (int i = 0; i < n_; ++i) closed = closed || impulse()[3 * i] > 0;
  if (!closed) return kNone;
  start = impulse();
  for (double last = kNone; newton_step();) {
    ++sweeps;
    const double change = correct(candidate, tolerance);
    if (!(change < last)) break;
    impulse() = candidate;
    if (change <= tolerance) return change;
    last = change;
  }
  impulse() = start;
  return kNone;
}

ContactSolution ContactSolver::solve(double tolerance, int max_iterations) {
  ContactSolution result;
  if (n_ == 0) return result;
  Vector candidate(store_[3].data(), 3 * n_);
  int sweeps = 0;
  if (const double change = newton_alone(sweeps, tolerance); change <= tolerance)
    return {sweeps, change};
  double change = sweep(impulse());
  ++sweeps;
  while (change > tolerance && sweeps < max_iterations) {
    const double candidate_change = newton_step() ? sweep(candidate) : change;
    ++sweeps;
    if (candidate_change < change) {
      impulse() = candidate;
      change = candidate_change;
      continue;
    }
    // Relaxation breaks cycles of sweeps. Chosen: 1 for the first 30 sweeps, which solve almost
    // every problem, then 0.6, and 0.25 from 100 sweeps on; the last of four sweeps has no
    // relaxation.
    const double share = sweeps < 30 ? 1.0 : sweeps < 100 ? 0.6 : 0.25;
    for (int i = 0; i < 4 && change > tolerance; ++i, ++sweeps)
      change = sweep(impulse(), i < 3 ? share : 1.0);
  }
  result.iterations = sweeps;
  result.residual = change;
  return result;
}

}  // namespace ayumi
