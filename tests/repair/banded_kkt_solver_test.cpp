// Ipopt with the banded solver is compared with Ipopt with MUMPS: the same solution after the same
// number of iterations, for programs along time, programs without order, and one that is not
// convex. It is also tested which programs of a process the banded solver serves: those of Ayumi
// and no others.

#include <coin/HSLLoader.h>
#include <gtest/gtest.h>

#include <thread>

#include "ayumi/repair/nlp/nlp.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// The minimum of 1/2 x' H x + c' x with rows in bounds, where H and the rows have the width `band`
// about the diagonal.
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
  nlp.upper[0] = 0.01;  // this variable has a bound of its own
  nlp.constraint_lower = VectorXd::Constant(m, -0.02);
  nlp.constraint_upper = VectorXd::Constant(m, 0.03);
  nlp.constraint_upper[0] = kNoBound;
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      if (q.A(i, j) == 0) continue;
      // Two nonzeros for one place are added.
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

// There are rows of one unknown, and unknowns of one row.
TEST(BandedKktSolver, SingleNeighbours) {
  Random random(23);
  Quadratic q = random_quadratic(random, 12, 12, 1);
  expect_same(program(q));
  q.H = MatrixXd::Identity(12, 12);
  q.A.setZero();
  q.A.row(0).setOnes();
  expect_same(program(q));
}

// A Hessian of the wrong sign is regularized: the solution goes downhill to the edge of a disc.
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

// The width of the vectors does not change a bit.
TEST(BandedKktSolver, EveryInstructionSetGivesTheSameBits) {
  Random random(25);
  for (const int n : {7, 40, 133}) {
    const Nlp nlp = program(random_quadratic(random, n, 2 * n, 6));
    NlpOptions options;
    const VectorXd widest = solve(nlp, options).x;
    options.plain_kernels = true;
    EXPECT_EQ(solve(nlp, options).x, widest);
  }
}

// ---- programs of the host

namespace {

int host_calls = 0;

void host_analyse(int*, int*, const int*, const int*, int*, int*, int*, int*, int*, int*, int*,
                  double*, int*, double*) {
  ++host_calls;
}
void host_factor(int*, int*, const int*, const int*, double*, int*, int*, int*, int*, int*, int*,
                 int*, int*, double*, int*) {
  ++host_calls;
}
void host_solve(int*, double*, int*, int*, int*, double*, int*, double*, int*, int*, int*,
                double*) {
  ++host_calls;
}
void host_defaults(int*, double*) { ++host_calls; }

extern "C" void ma27ad_(int*, int*, const int*, const int*, int*, int*, int*, int*, int*, int*,
                        int*, double*, int*, double*);

// INFO(1) of an analysis of the unit matrix by the MA27 of the process; it is 0 if some library
// serves it.
int outcome_of_ma27() {
  int n = 2, nz = 2, liw = 100, steps = 0, flag = 0, iw[100], ikeep[6], iw1[4], icntl[30] = {},
      info[20] = {};
  const int rows[] = {1, 2}, columns[] = {1, 2};
  double cntl[5] = {}, operations = 0;
  ma27ad_(&n, &nz, rows, columns, iw, &liw, ikeep, iw1, &steps, &flag, icntl, cntl, info,
          &operations);
  return info[0];
}

Nlp small_program() {
  Random random(24);
  return program(random_quadratic(random, 12, 24, 4));
}

}  // namespace

TEST(BandedKktSolver, LeavesNothingBehindInIpopt) {
  ASSERT_FALSE(LSL_isMA27available());
  EXPECT_EQ(solve(small_program()).status, NlpStatus::solved);
  EXPECT_FALSE(LSL_isMA27available());
  Nlp broken = small_program();
  broken.objective = [](const VectorXd&) -> double { fail(ErrorCode::internal, "broken"); };
  EXPECT_THROW(solve(broken), Error);
  EXPECT_FALSE(LSL_isMA27available());
}

// Other programs run on another thread of the host, and on the same thread from within the progress
// callback. If no HSL library is installed, their analysis fails as it would without Ayumi.
TEST(BandedKktSolver, ServesAyumisProgramsAlone) {
  if (LSL_isHSLLoaded()) GTEST_SKIP() << "an HSL library is loaded";
  int asked = 0, in_callback = 0, on_thread = 0;
  const Progress progress = [&](const ProgressEvent&) {
    ++asked;
    in_callback += outcome_of_ma27() == 0;
    std::thread other([&] { on_thread += outcome_of_ma27() == 0; });
    other.join();
    // A program of Ayumi within another.
    EXPECT_EQ(solve(small_program()).status, NlpStatus::solved);
    return true;
  };
  EXPECT_EQ(solve(small_program(), {}, progress).status, NlpStatus::solved);
  EXPECT_GT(asked, 3);
  EXPECT_EQ(in_callback, 0);
  EXPECT_EQ(on_thread, 0);
}

TEST(BandedKktSolver, LeavesTheHostsOwnMa27Alone) {
  LSL_setMA27(host_analyse, host_factor, host_solve, host_defaults);
  host_calls = 0;
  const NlpSolution with_host = solve(small_program());
  EXPECT_EQ(host_calls, 0);
  EXPECT_TRUE(LSL_isMA27available());
  outcome_of_ma27();
  EXPECT_EQ(host_calls, 1);
  LSL_setMA27(nullptr, nullptr, nullptr, nullptr);
  EXPECT_EQ(with_host.status, NlpStatus::solved);
  EXPECT_LT((with_host.x - solve(small_program()).x).norm(), 1e-8);
}
