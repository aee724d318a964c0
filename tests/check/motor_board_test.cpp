#include "ayumi/check/motor_board.hpp"

#include <gtest/gtest.h>

#include "tests/support/bus_robot.hpp"
#include "tests/support/degree.hpp"

namespace ayumi {
namespace {

using test::kDegree;

// Joint a has 209 counts per degree and moves from -18 to 90 degrees.
ReferenceTrajectory table_of_a(const std::vector<double>& degrees, double dt) {
  ReferenceTrajectory table;
  table.dt = dt;
  table.joints = {"a", "b", "c"};
  for (const double angle : degrees) {
    ReferenceRow row;
    row.theta = Eigen::Vector3d(angle * kDegree, 0, 0);
    table.rows.push_back(row);
  }
  return table;
}

double counts(const BoardTargets& board, Eigen::Index tick) {
  return board.targets(0, tick) / kDegree * 209;
}

TEST(MotorBoard, WholeCountsHoldUntilTheNextRow) {
  const BoardTargets board =
      board_targets(test::bus_robot(), table_of_a({10.001, 10.2, 10.2}, 0.002));
  EXPECT_EQ(board.dt, 0.001);
  ASSERT_EQ(board.targets.cols(), 5);
  EXPECT_NEAR(counts(board, 0), 2090, 1e-9);
  EXPECT_NEAR(counts(board, 1), 2090, 1e-9);
  EXPECT_NEAR(counts(board, 2), 2132, 1e-9);
  EXPECT_TRUE(board.clamps.empty());
}

TEST(MotorBoard, TheTargetMovesByAtMost57CountsPerMillisecond) {
  const BoardTargets board = board_targets(test::bus_robot(), table_of_a({10, 11, 11}, 0.002));
  for (Eigen::Index k = 0; k < 5; ++k)
    EXPECT_NEAR(counts(board, k), 2090 + (k < 2 ? 0 : 57 * (static_cast<double>(k) - 1)), 1e-9);
  ASSERT_EQ(board.clamps.size(), 1u);
  EXPECT_EQ(board.clamps[0].kind, Clamp::Kind::speed);
  EXPECT_EQ(board.clamps[0].joint, "a");
  EXPECT_NEAR(board.clamps[0].t, 0.002, 1e-12);
  EXPECT_NEAR(board.clamps[0].change, (209 - 57) / 209.0 * kDegree, 1e-9);
  EXPECT_EQ(board.clamps[0].rows, 3);
}

TEST(MotorBoard, TargetsStayWithinLimitsAnd16Bits) {
  const BoardTargets board = board_targets(test::bus_robot(), table_of_a({95, 95}, 0.001));
  EXPECT_NEAR(board.targets(0, 1), 90 * kDegree, 1e-9);
  ASSERT_EQ(board.clamps.size(), 1u);
  EXPECT_EQ(board.clamps[0].kind, Clamp::Kind::position);
  RobotDescription free = test::bus_description();
  free.joints[0].upper = 200 * kDegree;
  const BoardTargets far = board_targets(RobotModel(free), table_of_a({180, 180}, 0.001));
  EXPECT_NEAR(counts(far, 0), 32767, 1e-6);
  ASSERT_EQ(far.clamps.size(), 1u);
  EXPECT_EQ(far.clamps[0].kind, Clamp::Kind::range);
}

// The limits of a board are those of its type, in counts. So on a unit whose joint stands at -1
// degree while its encoder reads 0, the board stops the joint one degree below its own limit.
TEST(MotorBoard, LimitsAreInCountsOfTheEncoderAndNotInAnglesOfTheJoint) {
  RobotDescription description = test::bus_description();
  description.servos["a"].kp = 100;
  description.servos["a"].offset = -1 * kDegree;
  const RobotModel unit(description);
  const BoardTargets board = board_targets(unit, table_of_a({90, 90}, 0.001));
  EXPECT_NEAR(board.targets(0, 1), 89 * kDegree, 1e-9);
  ASSERT_EQ(board.clamps.size(), 1u);
  EXPECT_EQ(board.clamps[0].kind, Clamp::Kind::position);
  EXPECT_NEAR(board.clamps[0].change, 1 * kDegree, 1e-9);
  // At the other end, the counts allow what the joint does not.
  const BoardTargets low = board_targets(unit, table_of_a({-19, -19}, 0.001));
  EXPECT_NEAR(low.targets(0, 1), -19 * kDegree, 1e-9);
  EXPECT_TRUE(low.clamps.empty());
}

}  // namespace
}  // namespace ayumi
