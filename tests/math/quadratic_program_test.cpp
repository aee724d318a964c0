// Small quadratic programs: the conditions of Karush, Kuhn and Tucker, and the best of all active
// sets by trying each.
#include "ayumi/math/quadratic_program.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ayumi/math/linear_solve.hpp"
#include "ayumi/math/random.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double value(const QuadraticProgram& q, const VectorXd& x) {
  return 0.5 * x.dot(q.H * x) + q.f.dot(x);
}

/// A program with boxes and slanted inequalities around a point that satisfies them.
QuadraticProgram random_program(Random& random, int n, int slanted, const VectorXd& inside) {
  const auto number = [&] { return 2 * random.uniform() - 1; };
  MatrixXd root(n, n);
  for (int i = 0; i < root.size(); ++i) root.data()[i] = number();
  QuadraticProgram q;
  q.H = root * root.transpose() + 0.05 * MatrixXd::Identity(n, n);
  q.f = QuadraticProgram::Vector::Zero(n);
  for (int i = 0; i < n; ++i) q.f[i] = 3 * number();
  q.A = QuadraticProgram::Rows::Zero(2 + slanted, n);
  q.b.resize(2 + slanted);
  for (int i = 0; i < 2 + slanted; ++i) {
    if (i < 2)
      q.A(i, 0) = i == 0 ? 1 : -1;
    else
      for (int j = 0; j < n; ++j) q.A(i, j) = number();
    q.b[i] = q.A.row(i).dot(inside) + 0.5 * random.uniform();
  }
  return q;
}

/// The smallest value over the feasible solutions of all subsets of inequalities that hold as
/// equalities.
double least_by_trial(const QuadraticProgram& q) {
  const auto n = static_cast<int>(q.f.size()), rows = static_cast<int>(q.b.size());
  double least = std::numeric_limits<double>::infinity();
  for (int set = 0; set < (1 << rows); ++set) {
    std::vector<int> equal;
    for (int i = 0; i < rows; ++i)
      if (set & (1 << i)) equal.push_back(i);
    const auto m = static_cast<int>(equal.size());
    if (m > n) continue;
    MatrixXd kkt = MatrixXd::Zero(n + m, n + m);
    VectorXd right(n + m);
    kkt.topLeftCorner(n, n) = q.H;
    right.head(n) = -q.f;
    for (int i = 0; i < m; ++i) {
      kkt.row(n + i).head(n) = q.A.row(equal[static_cast<size_t>(i)]);
      kkt.col(n + i).head(n) = q.A.row(equal[static_cast<size_t>(i)]).transpose();
      right[n + i] = q.b[equal[static_cast<size_t>(i)]];
    }
    const VectorXd solved = solve_general(kkt, right);
    if (!solved.allFinite() || (kkt * solved - right).norm() > 1e-6) continue;
    const VectorXd x = solved.head(n);
    if ((q.A * x - q.b).maxCoeff() < 1e-9) least = std::min(least, value(q, x));
  }
  return least;
}

TEST(QuadraticProgram, KeepsTheConditionsAndIsTheBestOfAllActiveSets) {
  Random random(11);
  int met = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 2 + trial % 4;
    const VectorXd inside = VectorXd::Constant(n, 0.3);
    const QuadraticProgram q = random_program(random, n, 6, inside);
    const ProgramSolution s = solve_program(q, inside);
    ASSERT_TRUE(s.optimal) << trial;
    const VectorXd slack = q.b - q.A * s.x;
    EXPECT_GT(slack.minCoeff(), -1e-10);
    EXPECT_GE(s.multipliers.minCoeff(), 0);
    EXPECT_LT(s.multipliers.cwiseProduct(slack).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((q.H * s.x + q.f + q.A.transpose() * s.multipliers).norm(), 1e-9);
    EXPECT_NEAR(value(q, s.x), least_by_trial(q), 1e-9);
    met += static_cast<int>((s.multipliers.array() > 0).count());
  }
  EXPECT_GT(met, 100);  // the inequalities had an effect
}

TEST(QuadraticProgram, BeginsOnEdgesAndInCorners) {
  QuadraticProgram q;
  q.H = QuadraticProgram::Matrix::Identity(2, 2);
  q.f = Eigen::Vector2d(-2, -2);
  q.A.resize(5, 2);
  q.A << 1, 0, 0, 1, -1, 0, 0, -1, 1, 1;
  q.b.resize(5);
  q.b << 1, 1, 0, 0, 2;  // the last one touches the corner
  for (const Eigen::Vector2d& start :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1)}) {
    const ProgramSolution s = solve_program(q, start);
    EXPECT_LT((s.x - Eigen::Vector2d(1, 1)).norm(), 1e-12) << start.transpose();
  }
}

}  // namespace
}  // namespace ayumi
