#include "ayumi/repair/nlp/nlp.hpp"

#include <gtest/gtest.h>

using namespace ayumi;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

// The minimum of (x0 - 2)^2 + (x1 - 1)^2 on a disc, which is the point (2, 1) / sqrt 5 for radius
// 1.
Nlp disc(double radius2) {
  Nlp nlp;
  nlp.start = VectorXd::Zero(2);
  nlp.lower = VectorXd::Constant(2, -kNoBound);
  nlp.upper = VectorXd::Constant(2, kNoBound);
  nlp.constraint_lower = VectorXd::Constant(1, -kNoBound);
  nlp.constraint_upper = VectorXd::Constant(1, radius2);
  nlp.jacobian.add(0, 0);
  nlp.jacobian.add(0, 1);
  nlp.hessian.add(0, 0);
  nlp.hessian.add(1, 1);
  nlp.objective = [](const VectorXd& x) { return (x - Vector2d(2, 1)).squaredNorm(); };
  nlp.gradient = [](const VectorXd& x, VectorXd& g) { g = 2 * (x - Vector2d(2, 1)); };
  nlp.constraints = [](const VectorXd& x, VectorXd& g) { g[0] = x.squaredNorm(); };
  nlp.jacobian_values = [](const VectorXd& x, VectorXd& v) { v = 2 * x; };
  nlp.hessian_values = [](const VectorXd&, double scale, const VectorXd& multipliers, VectorXd& v) {
    v.setConstant(2 * scale + 2 * multipliers[0]);
  };
  return nlp;
}

// The minimum of 10 x^2 + y^2 / 2 above two lines that meet in a kink at (0, 1). Newton's steps do
// not know the kink, and alternate between the lines.
Nlp kink() {
  Nlp nlp;
  nlp.start = Vector2d(0.3, 2);
  nlp.lower = VectorXd::Constant(2, -kNoBound);
  nlp.upper = VectorXd::Constant(2, kNoBound);
  nlp.constraint_lower = VectorXd::Constant(1, 1);
  nlp.constraint_upper = VectorXd::Constant(1, kNoBound);
  nlp.jacobian.add(0, 0);
  nlp.jacobian.add(0, 1);
  nlp.hessian.add(0, 0);
  nlp.hessian.add(1, 1);
  const auto slope = [](double x) { return x < 0 ? 0.02 : -0.013; };
  nlp.objective = [](const VectorXd& x) { return 10 * x[0] * x[0] + 0.5 * x[1] * x[1]; };
  nlp.gradient = [](const VectorXd& x, VectorXd& g) { g << 20 * x[0], x[1]; };
  nlp.constraints = [=](const VectorXd& x, VectorXd& g) { g[0] = x[1] + slope(x[0]) * x[0]; };
  nlp.jacobian_values = [=](const VectorXd& x, VectorXd& v) { v << slope(x[0]), 1; };
  nlp.hessian_values = [](const VectorXd&, double scale, const VectorXd&, VectorXd& v) {
    v << 20 * scale, scale;
  };
  return nlp;
}

}  // namespace

TEST(Nlp, NearestPointOfADisc) {
  const NlpSolution s = solve(disc(1));
  EXPECT_EQ(s.status, NlpStatus::solved);
  EXPECT_LT((s.x - Vector2d(2, 1) / std::sqrt(5)).norm(), 1e-6);
  EXPECT_LT(s.violation, 1e-7);
  EXPECT_GT(s.iterations, 1);
}

TEST(Nlp, ImpossibleConstraintIsInfeasible) {
  EXPECT_EQ(solve(disc(-1)).status, NlpStatus::infeasible);
}

TEST(Nlp, EndsAtAKink) {
  NlpOptions options;
  EXPECT_EQ(solve(kink(), options).status, NlpStatus::iteration_limit);
  options.still_change = repair_policy::solver::kKinkChange;
  const NlpSolution s = solve(kink(), options);
  EXPECT_EQ(s.status, NlpStatus::solved);
  EXPECT_LT(s.iterations, 40);
  EXPECT_LE(s.violation, 1e-7);
  EXPECT_LT((s.x - Vector2d(0, 1)).norm(), 0.02);
}

TEST(Nlp, ProgressHearsEveryIterationAndStops) {
  int heard = 0;
  auto count = [&](const ProgressEvent& e) {
    EXPECT_EQ(e.stage, "disc");
    return ++heard < 3;
  };
  EXPECT_THROW(solve(disc(1), {}, count, "disc"), Interrupted);
  EXPECT_EQ(heard, 3);
}

TEST(Nlp, ErrorsOfTheFunctionsComeThrough) {
  Nlp nlp = disc(1);
  nlp.objective = [](const VectorXd&) -> double { fail(ErrorCode::internal, "broken"); };
  EXPECT_THROW(solve(nlp), Error);
}
