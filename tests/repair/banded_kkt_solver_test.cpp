// The linear systems of Ipopt by condensing against those by MUMPS: the same solution by the same
// way, for programs along time, programs without order, and one that is not convex.

#include <gtest/gtest.h>

#include "ayumi/repair/nlp/nlp.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// min 1/2 x' H x + c' x with rows in bounds, H and the rows of width `band` about the diagonal.
struct Quadratic {
  MatrixXd H, A;
  VectorXd c;
};

Quadratic random_quadratic(Random& random, int n, int rows, int band) {
  Quadratic q{MatrixXd::Zero(n, n), MatrixXd::Zero(rows, n), random.vector(n, 1)};
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - band); j <= i; ++j)
      q.H(i, j) = q.H(j, i) = i == j ? 3.0 * band : random.uniform();
  for (int i = 0; i < rows; ++i) {
    const int first = static_cast<int>(random.uniform(0, n - band));
    for (int j = 0; j < band; ++j) q.A(i, first + j) = random.uniform();
  }
  return q;
}

Nlp program(const Quadratic& q) {
  Nlp nlp;
  const auto n = q.c.size(), m = q.A.rows();
  nlp.start = VectorXd::Zero(n);
  nlp.lower = VectorXd::Constant(n, -kNoBound);
  nlp.upper = VectorXd::Constant(n, kNoBound);
  nlp.upper[0] = 0.01;  // a variable with a bound of its own
  nlp.constraint_lower = VectorXd::Constant(m, -0.02);
  nlp.constraint_upper = VectorXd::Constant(m, 0.03);
  nlp.constraint_upper[0] = kNoBound;
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      if (q.A(i, j) == 0) continue;
      // Two nonzeros for one place: they add.
      nlp.jacobian.add(static_cast<int>(i), static_cast<int>(j));
      nlp.jacobian.add(static_cast<int>(i), static_cast<int>(j));
    }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (q.H(i, j) != 0) nlp.hessian.add(static_cast<int>(i), static_cast<int>(j));
  nlp.objective = [q](const VectorXd& x) { return 0.5 * x.dot(q.H * x) + q.c.dot(x); };
  nlp.gradient = [q](const VectorXd& x, VectorXd& g) { g = q.H * x + q.c; };
  nlp.constraints = [q](const VectorXd& x, VectorXd& g) { g = q.A * x; };
  nlp.jacobian_values = [q, p = nlp.jacobian](const VectorXd&, VectorXd& v) {
    for (int k = 0; k < p.size(); ++k) v[k] = 0.5 * q.A(p.rows[k], p.columns[k]);
  };
  nlp.hessian_values = [q, p = nlp.hessian](const VectorXd&, double scale, const VectorXd&,
                                            VectorXd& v) {
    for (int k = 0; k < p.size(); ++k) v[k] = scale * q.H(p.rows[k], p.columns[k]);
  };
  return nlp;
}

void expect_same(const Nlp& nlp) {
  NlpOptions options;
  const NlpSolution condensed = solve(nlp, options);
  options.mumps = true;
  const NlpSolution mumps = solve(nlp, options);
  ASSERT_EQ(mumps.status, NlpStatus::solved);
  ASSERT_EQ(condensed.status, NlpStatus::solved);
  EXPECT_EQ(condensed.iterations, mumps.iterations);
  EXPECT_LT((condensed.x - mumps.x).norm(), 1e-8);
  EXPECT_LT(condensed.violation, 1e-7);
}

}  // namespace

TEST(BandedKktSolver, BandsAlongTime) {
  Random random(21);
  for (const int n : {7, 40, 133}) expect_same(program(random_quadratic(random, n, 2 * n, 6)));
}

TEST(BandedKktSolver, UnknownsInAnyOrder) {
  Random random(22);
  const int n = 60;
  Quadratic q = random_quadratic(random, n, 2 * n, 5);
  Eigen::PermutationMatrix<Eigen::Dynamic> other(n);
  other.setIdentity();
  for (int i = n - 1; i > 0; --i)
    std::swap(other.indices()[i], other.indices()[static_cast<int>(random.uniform(0, i + 0.99))]);
  q.H = other * q.H * other.transpose();
  q.A = q.A * other.transpose();
  q.c = other * q.c;
  expect_same(program(q));
}

// Rows of one unknown, and unknowns of one row.
TEST(BandedKktSolver, SingleNeighbours) {
  Random random(23);
  Quadratic q = random_quadratic(random, 12, 12, 1);
  expect_same(program(q));
  q.H = MatrixXd::Identity(12, 12);
  q.A.setZero();
  q.A.row(0).setOnes();
  expect_same(program(q));
}

// A Hessian of the wrong sign is regularized: down the hill to the edge of a disc.
TEST(BandedKktSolver, NotConvex) {
  Nlp nlp;
  nlp.start = Eigen::Vector2d(0.1, 0.02);
  nlp.lower = VectorXd::Constant(2, -kNoBound);
  nlp.upper = VectorXd::Constant(2, kNoBound);
  nlp.constraint_lower = VectorXd::Constant(1, -kNoBound);
  nlp.constraint_upper = VectorXd::Constant(1, 1);
  for (int i : {0, 1}) {
    nlp.jacobian.add(0, i);
    nlp.hessian.add(i, i);
  }
  nlp.objective = [](const VectorXd& x) { return -x[0] * x[0] + x[1] * x[1]; };
  nlp.gradient = [](const VectorXd& x, VectorXd& g) { g = Eigen::Vector2d(-2 * x[0], 2 * x[1]); };
  nlp.constraints = [](const VectorXd& x, VectorXd& g) { g[0] = x.squaredNorm(); };
  nlp.jacobian_values = [](const VectorXd& x, VectorXd& v) { v = 2 * x; };
  nlp.hessian_values = [](const VectorXd&, double scale, const VectorXd& y, VectorXd& v) {
    v = Eigen::Vector2d(-2 * scale + 2 * y[0], 2 * scale + 2 * y[0]);
  };
  const NlpSolution s = solve(nlp);
  ASSERT_EQ(s.status, NlpStatus::solved);
  EXPECT_LT((s.x - Eigen::Vector2d(1, 0)).norm(), 1e-5);
}
