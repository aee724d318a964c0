#include "ayumi/sim/plant/contact_solver.hpp"

#include <gtest/gtest.h>

#include "ayumi/math/rotation.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// The data of ContactSolver for as many contacts as there are friction coefficients.
struct ContactProblem {
  MatrixXd A;
  VectorXd b;
  std::vector<double> friction;
};

/// `impulse` is the initial guess and receives the solution.
ContactSolution solve_contacts(const ContactProblem& problem, VectorXd& impulse) {
  ContactSolver solver;
  solver.resize(static_cast<int>(problem.friction.size()));
  solver.A() = problem.A;
  solver.b() = problem.b;
  solver.impulse() = impulse;
  solver.friction() = problem.friction;
  const ContactSolution result = solver.solve();
  impulse = solver.impulse();
  return result;
}

/// A rigid body touches level ground in n points: A has rank 6, and the rest of A is only the
/// compliance, as on a real sole.
ContactProblem random_problem(test::Random& random, int n, double compliance) {
  ContactProblem problem;
  const double mass = random.uniform(1, 10);
  Eigen::Matrix<double, 6, 1> inverse;
  inverse << Eigen::Vector3d::Constant(1 / mass),
      Eigen::Vector3d::Constant(1 / (mass * random.uniform(0.01, 0.05)));
  MatrixXd J(3 * n, 6);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d r(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), -0.2);
    Eigen::Matrix3d ground;  // rows: the normal and the tangents
    ground << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    J.block<3, 3>(3 * i, 0) = ground;
    J.block<3, 3>(3 * i, 3) = -ground * skew(r);
  }
  problem.A = J * inverse.asDiagonal() * J.transpose() +
              compliance / mass * MatrixXd::Identity(3 * n, 3 * n);
  const VectorXd twist = random.vector(6, 1.0);
  problem.b = J * twist + random.vector(3 * n, 0.05);
  for (int i = 0; i < n; ++i) problem.b[3 * i] -= 0.3;
  for (int i = 0; i < n; ++i) problem.friction.push_back(random.uniform(0.1, 1.0));
  return problem;
}

TEST(ContactSolver, MeetsCoulombsConditionsOnRandomProblems) {
  test::Random random(7);
  int sliding = 0, sticking = 0, open = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 1 + trial % 8;
    const ContactProblem problem = random_problem(random, n, trial % 2 ? 1e-1 : 1e-2);
    VectorXd l = VectorXd::Zero(3 * n);
    const ContactSolution solution = solve_contacts(problem, l);
    ASSERT_LE(solution.residual, 1e-10) << trial;
    const VectorXd u = problem.A * l + problem.b;
    for (int i = 0; i < n; ++i) {
      const double ln = l[3 * i], un = u[3 * i], mu = problem.friction[i];
      const Vector2d lt = l.segment<2>(3 * i + 1), ut = u.segment<2>(3 * i + 1);
      EXPECT_GE(ln, 0);
      EXPECT_GE(un, -1e-8);
      EXPECT_NEAR(ln * un, 0, 1e-7 * (1 + ln));
      EXPECT_LE(lt.norm(), mu * ln * (1 + 1e-9) + 1e-12);
      if (ln == 0) {
        ++open;
      } else if (lt.norm() < mu * ln * (1 - 1e-6)) {
        EXPECT_LT(ut.norm(), 1e-7) << "a sticking contact moves";
        ++sticking;
      } else {
        EXPECT_NEAR(lt.dot(ut), -lt.norm() * ut.norm(), 1e-6 * (1 + lt.norm() * ut.norm()))
            << "friction must oppose the slip";
        ++sliding;
      }
    }
  }
  EXPECT_GT(sliding, 50);
  EXPECT_GT(sticking, 50);
  EXPECT_GT(open, 50);
}

TEST(ContactSolver, FrictionlessAndSingleContactsHaveClosedForms) {
  ContactProblem problem;
  problem.A = MatrixXd::Identity(3, 3) * 0.5;
  problem.b = Eigen::Vector3d(-1, 0.3, 0);
  problem.friction = {0.0};
  VectorXd l = VectorXd::Zero(3);
  solve_contacts(problem, l);
  EXPECT_NEAR((l - Eigen::Vector3d(2, 0, 0)).norm(), 0, 1e-12);
  problem.friction = {0.2};  // it slides: l_t = mu l_n against the motion
  l.setZero();
  solve_contacts(problem, l);
  EXPECT_NEAR((l - Eigen::Vector3d(2, -0.4, 0)).norm(), 0, 1e-12);
  problem.friction = {0.5};  // it sticks
  l.setZero();
  solve_contacts(problem, l);
  EXPECT_NEAR((l - Eigen::Vector3d(2, -0.6, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace ayumi
