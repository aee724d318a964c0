#include "ayumi/control/body_tasks.hpp"

#include <gtest/gtest.h>

#include "ayumi/math/weighted_solve.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::VectorXd;

// What the general solve gives; so do tasks that say the same thing twice, where the factor breaks
// down.
TEST(BodyTasks, AreSolvedAsAnyTasks) {
  test::Random random(5);
  BodyTasks tasks;
  const int n = 20;
  tasks.J.setZero(BodyTasks::kRows, n);
  for (int j = 0; j < n; ++j) {
    const int lead = j < 8 ? 12 : j < 14 ? 9 : 3;
    tasks.J.col(j).head(lead) = random.vector(lead, 1.0);
  }
  tasks.u = random.vector(BodyTasks::kRows, 1.0);
  const VectorXd w = (random.vector(n, 1.0).array() + 1.5).matrix(), x0 = random.vector(n, 1.0);
  BodyTasks::Rows room;
  VectorXd x;
  for (const double damping : {1e-5, 0.0}) {
    solve_tasks(tasks, w, x0, damping, room, x);
    const VectorXd expected = weighted_least_norm(tasks.J, tasks.u, w, x0, damping);
    EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  }
  EXPECT_LT((tasks.J * x - tasks.u).norm(), 1e-11);
  tasks.J.row(1) = tasks.J.row(0);
  tasks.u[1] = tasks.u[0];
  solve_tasks(tasks, w, x0, 0, room, x);
  EXPECT_LT((tasks.J * x - tasks.u).norm(), 1e-8);
}

}  // namespace
}  // namespace ayumi
