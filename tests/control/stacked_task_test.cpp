#include <gtest/gtest.h>

#include "ayumi/control/whole_body.hpp"
#include "ayumi/math/weighted_solve.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::VectorXd;

// The result is that of the general solve, even for tasks with two equal rows, for which the
// factorization fails.
TEST(StackedTask, IsSolvedAsAnyTask) {
  test::Random random(5);
  StackedTask task;
  const int n = 20;
  task.J.setZero(StackedTask::kRows, n);
  for (int j = 0; j < n; ++j) {
    const int lead = j < 8 ? 12 : j < 14 ? 9 : 3;
    task.J.col(j).head(lead) = random.vector(lead, 1.0);
  }
  task.u = random.vector(StackedTask::kRows, 1.0);
  const VectorXd w = (random.vector(n, 1.0).array() + 1.5).matrix(), x0 = random.vector(n, 1.0);
  StackedTask::Rows room;
  VectorXd x;
  for (const double damping : {1e-5, 0.0}) {
    solve_stacked_task(task, w, x0, damping, room, x);
    const VectorXd expected = weighted_least_norm(task.J, task.u, w, x0, damping);
    EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  }
  EXPECT_LT((task.J * x - task.u).norm(), 1e-11);
  task.J.row(1) = task.J.row(0);
  task.u[1] = task.u[0];
  solve_stacked_task(task, w, x0, 0, room, x);
  EXPECT_LT((task.J * x - task.u).norm(), 1e-8);
}

}  // namespace
}  // namespace ayumi
