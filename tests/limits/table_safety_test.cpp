#include "ayumi/limits/table_safety.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "tests/support/bus_robot.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using test::kDegree;

ReferenceTrajectory still(size_t rows, const Eigen::Vector3d& degrees) {
  ReferenceTrajectory table;
  table.joints = {"a", "b", "c"};
  for (size_t k = 0; k < rows; ++k) {
    ReferenceRow row;
    row.theta = degrees * kDegree;
    table.rows.push_back(row);
  }
  return table;
}

TEST(ExportSafety, RampLeavesThePostureAndArrivesAtRest) {
  const RobotModel robot = test::bus_robot();
  const SafeTable safe = make_safe(robot, still(10, {30, 20, 0}), {});
  EXPECT_TRUE(safe.report.safe);
  EXPECT_EQ(safe.first, 2000u);
  EXPECT_DOUBLE_EQ(safe.report.ramp, 2.0);
  EXPECT_DOUBLE_EQ(safe.report.hold, 0.5);
  ASSERT_EQ(safe.table.rows.size(), 2000u + 10 + 500);
  const auto a = [&](size_t k) { return safe.table.rows[k].theta[0] / kDegree; };
  EXPECT_NEAR(a(0), 10, 1e-12);
  EXPECT_NEAR(a(1), 10, 1e-6);     // it starts at rest
  EXPECT_NEAR(a(1000), 20, 1e-9);  // it is half way at half of the time
  EXPECT_NEAR(a(1999), 30, 1e-6);  // it arrives at rest
  EXPECT_EQ(a(2000), a(2509));
  // Peak speed of the minimum jerk: 1.875 distance / duration.
  EXPECT_NEAR((a(1001) - a(999)) / 0.002, 1.875 * 20 / 2.0, 1e-3);
}

TEST(ExportSafety, RampGrowsWithTheDistance) {
  const RobotModel robot = test::bus_robot();
  SafetyOptions options;
  options.ramp = 0.01;
  const SafeTable safe = make_safe(robot, still(2, {80, 0, 0}), options);
  EXPECT_TRUE(safe.report.safe);
  EXPECT_GT(safe.report.ramp, 1.875 * 70 * kDegree / 2.38 - 1e-9);
  EXPECT_LE(safe.report.max_step_ratio, 0.55);
  EXPECT_EQ(safe.report.worst_joint, "a");
}

// The report on the targets alone is the same as that on the table with ramp and hold, and a plain
// loop over its rows confirms it.
TEST(ExportSafety, TargetsAloneGiveTheReportOfTheirTable) {
  const RobotModel robot = test::bus_robot();
  test::Random random(5);
  ReferenceTrajectory table = still(40, {0, 0, 0});
  table.joints = {"c", "a", "b"};
  for (ReferenceRow& row : table.rows) row.theta = random.vector(3, 1.7);
  TargetRows targets;
  targets.dt = table.dt;
  targets.joints = table.joints;
  targets.count = table.rows.size();
  targets.row = [&](size_t k, Eigen::VectorXd& theta) { theta = table.rows[k].theta; };
  const SafetyReport alone = safety_of_targets(robot, targets, {});
  const SafeTable safe = make_safe(robot, table, {});
  EXPECT_EQ(alone.safe, safe.report.safe);
  EXPECT_EQ(alone.ramp, safe.report.ramp);
  EXPECT_EQ(alone.worst_joint, safe.report.worst_joint);
  EXPECT_EQ(alone.worst_at, safe.report.worst_at);
  EXPECT_EQ(alone.max_step_ratio, safe.report.max_step_ratio);
  EXPECT_EQ(alone.end_speed, safe.report.end_speed);
  EXPECT_EQ(alone.violations.size(), safe.report.violations.size());
  EXPECT_EQ(alone.rows.size(), safe.report.rows.size());
  const Eigen::MatrixXi counts = encoder_counts(robot, safe.table, {});
  const Eigen::VectorXd largest = count_step_limits(robot, table.dt, {});
  double ratio = 0, margin = 1e9;
  size_t steps = 0;
  for (Eigen::Index k = 0; k < counts.rows(); ++k)
    for (int dof = 0; dof < robot.dof_count(); ++dof) {
      const Dof& joint = robot.dofs()[static_cast<size_t>(dof)];
      const double theta = safe.table.rows[static_cast<size_t>(k)].theta[(dof + 1) % 3];
      if (joint.limited) margin = std::min({margin, theta - joint.lower, joint.upper - theta});
      if (k == 0 || !std::isfinite(largest[dof])) continue;
      const double step = std::abs(counts(k, dof) - counts(k - 1, dof)) / largest[dof];
      ratio = std::max(ratio, step);
      steps += step > 1 ? 1 : 0;
    }
  EXPECT_EQ(alone.max_step_ratio, ratio);
  EXPECT_DOUBLE_EQ(alone.min_limit_margin + robot.description().soft_limit_margin, margin);
  const auto is_step = [](const SafetyViolation& v) { return v.kind == TableLimit::step; };
  EXPECT_EQ(std::count_if(alone.rows.begin(), alone.rows.end(), is_step),
            static_cast<std::ptrdiff_t>(steps));
  EXPECT_GT(steps, 10u);
}

TEST(ExportSafety, ARampThatIsTooLongIsRefused) {
  const RobotModel robot = test::bus_robot();
  const std::string message = test::error_message(
      [&] {
        make_safe(robot, still(2, {1e9, 0, 0}), {});
      },
      ErrorCode::bad_pattern);
  EXPECT_NE(message.find("begins so far from posture 'home' that the ramp to its first row would "
                         "take "),
            std::string::npos)
      << message;
  // The safety of the targets can be judged nevertheless.
  TargetRows targets;
  targets.joints = {"a", "b", "c"};
  targets.count = 2;
  targets.row = [](size_t, Eigen::VectorXd& theta) { theta = Eigen::Vector3d(1e9, 0, 0); };
  const SafetyReport report = safety_of_targets(robot, targets, {});
  EXPECT_FALSE(report.safe);
  ASSERT_FALSE(report.violations.empty());
  EXPECT_EQ(report.violations[0].joint, "a");
  EXPECT_EQ(report.ramp, SafetyOptions().ramp);
}

TEST(ExportSafety, FindsTheStepThatIsTooLarge) {
  const RobotModel robot = test::bus_robot();
  ReferenceTrajectory table = still(10, {10, 0, 0});
  for (size_t k = 5; k < 10; ++k) table.rows[k].theta[1] = 61.2 / 209 * kDegree;
  const SafetyReport report = make_safe(robot, table, {}).report;
  EXPECT_FALSE(report.safe);
  ASSERT_EQ(report.violations.size(), 1u);
  const SafetyViolation& found = report.violations[0];
  EXPECT_EQ(found.kind, TableLimit::step);
  EXPECT_EQ(found.joint, "b");
  EXPECT_DOUBLE_EQ(found.t, 2.005);
  EXPECT_EQ(found.value, 61);
  EXPECT_EQ(found.limit, 57);
  EXPECT_EQ(text_of(found),
            "b at 2.005 s (0.005 s of the pattern): step 61 counts, limit 57 counts (in 1 row)");
}

TEST(ExportSafety, FindsThePositionBeyondTheSoftLimit) {
  RobotDescription description = test::bus_description();
  description.soft_limit_margin = 1 * kDegree;
  const RobotModel robot(description);
  const SafetyReport report = make_safe(robot, still(10, {10, 89.5, 0}), {}).report;
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, TableLimit::position);
  EXPECT_EQ(report.violations[0].joint, "b");
  EXPECT_NEAR(report.violations[0].limit, 89 * kDegree, 1e-12);
  EXPECT_NEAR(report.min_limit_margin, -0.5 * kDegree, 1e-12);
  EXPECT_EQ(report.margin_joint, "b");
}

// A safe table keeps both the limits of the joint and those of the counts, which motor boards keep.
// So the boards of a unit with another zero do not change it.
TEST(ExportSafety, TheLimitsHoldForTheJointAndForItsEncoder) {
  RobotDescription description = test::bus_description();
  description.servos["b"].kp = 100;
  for (const double zero : {0.4, -0.4}) {
    description.servos["b"].offset = zero * kDegree;
    const RobotModel unit(description);
    const double lower = -18 + std::max(zero, 0.0), upper = 90 + std::min(zero, 0.0);
    const TargetRange range = target_range(unit.dofs()[1], zero * kDegree, 0);
    EXPECT_NEAR(range.lower, lower * kDegree, 1e-12);
    EXPECT_NEAR(range.upper, upper * kDegree, 1e-12);
    for (const double inside : {lower, upper}) {
      const double beyond = inside + (inside > 0 ? 0.1 : -0.1);
      EXPECT_TRUE(make_safe(unit, still(10, {10, inside, 0}), {}).report.safe) << inside;
      const SafetyReport report = make_safe(unit, still(10, {10, beyond, 0}), {}).report;
      ASSERT_EQ(report.violations.size(), 1u) << beyond;
      EXPECT_EQ(report.violations[0].kind, TableLimit::position);
      EXPECT_NEAR(report.violations[0].limit, inside * kDegree, 1e-12);
    }
  }
}

// A home posture at a limit is where the motor board of the unit stops, so the ramp begins there.
TEST(ExportSafety, AUnitWhoseHomePostureIsAtALimitCanBeExported) {
  RobotDescription description = test::bus_description();
  description.servos["b"].kp = 100;
  description.servos["b"].offset = 0.4 * kDegree;
  description.postures["home"]["b"] = -18 * kDegree;
  const RobotModel unit(description);
  const SafetyReport report = make_safe(unit, still(10, {10, 0, 0}), {}).report;
  EXPECT_TRUE(report.safe) << report.violations.size();
}

TEST(ExportSafety, FindsMovingEnds) {
  const RobotModel robot = test::bus_robot();
  ReferenceTrajectory table = still(10, {10, 0, 0});
  for (size_t k = 0; k < 10; ++k) table.rows[k].theta[2] = 0.0002 * static_cast<double>(k);
  const SafetyReport report = make_safe(robot, table, {}).report;
  ASSERT_EQ(report.violations.size(), 2u);
  EXPECT_EQ(report.violations[0].kind, TableLimit::start_speed);
  EXPECT_EQ(report.violations[1].kind, TableLimit::end_speed);
  EXPECT_NEAR(report.start_speed, 0.2, 1e-9);
  EXPECT_NEAR(report.end_speed, 0.2, 1e-9);
}

TEST(ExportSafety, RefusesAnotherRobotsTable) {
  const RobotModel robot = test::bus_robot();
  ReferenceTrajectory table = still(1, {0, 0, 0});
  table.joints[2] = "d";
  try {
    make_safe(robot, table, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the joint table has no column for joint 'c' of robot 'bus'");
  }
  table = still(0, {0, 0, 0});
  EXPECT_THROW(make_safe(robot, table, {}), Error);
}

// At exactly the speed limit, and at the position limits, rounding alone must not exceed a limit.
TEST(ExportSafety, TorquesBeyondThePeakMakeARunUnsafe) {
  constexpr double peak = 2.5;
  RobotDescription description = test::bus_description();
  description.profiles.front().peak_torque = {{"b", peak}};
  const RobotModel robot(description);
  const ReferenceTrajectory table = still(10, {10, 20, 0});
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(10, 3);
  EXPECT_TRUE(make_safe_run(robot, table, torque, {}).report.safe);
  torque(4, 1) = -1.5 * peak;
  torque(6, 1) = 1.2 * peak;
  const SafetyReport report = make_safe_run(robot, table, torque, {}).report;
  EXPECT_FALSE(report.safe);
  ASSERT_EQ(report.violations.size(), 1u);
  const SafetyViolation& worst = report.violations[0];
  EXPECT_EQ(worst.kind, TableLimit::torque);
  EXPECT_EQ(worst.joint, "b");
  EXPECT_EQ(worst.value, 1.5 * peak);
  EXPECT_EQ(worst.limit, peak);
  EXPECT_NEAR(worst.t, report.ramp + 4 * table.dt, 1e-9);
}

TEST(ExportSafety, RoundingKeepsTheLimitsThatTheMotionKeeps) {
  const RobotModel robot = test::bus_robot();
  ReferenceTrajectory table = still(1, {0, 0, 0});
  table.rows.clear();
  const double step = 57.0 / 209 * kDegree;
  double x = 0.3 * step;
  double direction = 1;
  for (int k = 0; k < 5000; ++k) {
    ReferenceRow row;
    row.theta = Eigen::Vector3d(x, x, -18 * kDegree + 1e-12);
    table.rows.push_back(row);
    if (x + direction * step > 1.5 || x + direction * step < -0.3) direction = -direction;
    x += direction * step * (k % 7 == 0 ? 0.93 : 1.0);
  }
  const Eigen::VectorXd limits = count_step_limits(robot, table.dt, {});
  EXPECT_EQ(limits, Eigen::Vector3d::Constant(57));
  const Eigen::MatrixXi counts = encoder_counts(robot, table, {});
  for (Eigen::Index k = 0; k < counts.rows(); ++k) {
    EXPECT_GE(counts(k, 2), -18 * 209);
    for (int dof = 0; dof < 3; ++dof) {
      const double scale = dof == 1 ? -209 : 209;
      const double exact = table.rows[static_cast<size_t>(k)].theta[dof] / kDegree * scale;
      EXPECT_LT(std::abs(counts(k, dof) - exact), 1);
      if (k > 0) {
        EXPECT_LE(std::abs(counts(k, dof) - counts(k - 1, dof)), 57);
      }
    }
  }
}

TEST(ExportSafety, SpeedLimitOfTheProfileCountsWhereItIsLower) {
  RobotDescription description = test::bus_description();
  description.profiles[0].speed["c"] = 2.0;
  const RobotModel robot(description);
  // 2 rad/s = 114.59 deg/s = 23.95 counts/ms
  EXPECT_EQ(count_step_limits(robot, 0.001, {}), Eigen::Vector3d(57, 57, 23));
  EXPECT_EQ(count_step_limits(robot, 0.002, {}), Eigen::Vector3d(114, 114, 47));
}

}  // namespace
}  // namespace ayumi
