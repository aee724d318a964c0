// The Riccati equation: its residual, the closed form for one state, and the cost summed step by
// step.
#include "ayumi/math/riccati.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/math/random.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_numbers(Random& random, int rows, int columns) {
  MatrixXd m(rows, columns);
  for (int i = 0; i < m.size(); ++i) m.data()[i] = 2 * random.uniform() - 1;
  return m;
}

TEST(Riccati, OneStateHasItsClosedForm) {
  for (const double a : {0.5, 1.0, 1.7})
    for (const double r : {0.1, 3.0}) {
      const MatrixXd A = MatrixXd::Constant(1, 1, a), one = MatrixXd::Ones(1, 1);
      const double P = solve_riccati(A, one, one, r * one)(0, 0);
      // P = a^2 P - a^2 P^2 / (r + P) + 1, a quadratic equation.
      const double b = r - a * a * r - 1;
      EXPECT_NEAR(P, 0.5 * (-b + std::sqrt(b * b + 4 * r)), 1e-12 * P);
    }
}

TEST(Riccati, ResidualIsZeroAndTheCostIsThatOfTheRegulatedSystem) {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const MatrixXd A = 1.2 * random_numbers(random, 4, 4), B = random_numbers(random, 4, 2);
    const MatrixXd root = random_numbers(random, 4, 4), Q = root * root.transpose();
    const MatrixXd R = 0.3 * MatrixXd::Identity(2, 2);
    const MatrixXd P = solve_riccati(A, B, Q, R), K = regulator_gain(A, B, R, P);
    const MatrixXd residual = A.transpose() * P * A - A.transpose() * P * B * K + Q - P;
    EXPECT_LT(residual.norm(), 1e-10 * P.norm()) << trial;
    VectorXd x = random_numbers(random, 4, 1);
    const double expected = x.dot(P * x);
    double cost = 0;
    for (int k = 0; k < 2000; ++k) {
      const VectorXd u = -K * x;
      cost += x.dot(Q * x) + u.dot(R * u);
      x = A * x + B * u;
    }
    EXPECT_NEAR(cost, expected, 1e-9 * expected) << trial;
  }
}

TEST(Riccati, RefusesASystemThatNoInputHolds) {
  const MatrixXd A = 2 * MatrixXd::Identity(1, 1), none = MatrixXd::Zero(1, 1),
                 one = MatrixXd::Ones(1, 1);
  EXPECT_THROW(solve_riccati(A, none, one, one), Error);
}

}  // namespace
}  // namespace ayumi
