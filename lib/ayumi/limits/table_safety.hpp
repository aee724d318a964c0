#pragma once
// Prepares a table for a real robot: an approach ramp, an end hold, and a check of the targets that
// the servos would receive, in whole encoder counts if the robot has them. Servos follow every row
// at once, so the table itself has to be safe.

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct SafetyOptions {
  /// Bounds of the ramp and of the hold. Chosen: a robot that approaches or waits for longer than a
  /// minute looks as if it had stopped.
  static constexpr Bounds kRest = {0, 60, "s"};

  std::string profile;        ///< actuator profile for the speed limits; "" for the default
  double ramp = 2.0;          ///< smallest duration of the approach [s]; 0 for no ramp
  std::string from = "home";  ///< named posture the robot stands in; "first" = the first row
  double hold = 0.5;          ///< time for which the last row is repeated [s]
  double counts_per_ms = 57;  ///< speed limit of the motor board [counts/ms]
  double step_share = 1;      ///< share of the largest step that may be used
  /// Distance by which a target may exceed the soft limits [rad], [m]. Chosen: a hundredth of a
  /// count of HOAP's encoders; if a motion starts from rest at a limit, its first targets lead the
  /// joint and exceed the limit by 4e-9 rad.
  double beyond_range = 1e-6;
  double rest_speed = 0.1;  ///< speed below which the start and the end count as rest [rad/s]
  double rest_window = 0;   ///< time over which the speed is a mean [s]; with 0, one row
};

/// The options for an imported sequence whose rows are kept and which is already complete. It gets
/// no ramp and no hold. Its speed at both ends is a mean over several rows, because its rows are
/// whole counts.
SafetyOptions as_it_is(SafetyOptions options);

/// What a table must keep so that it may be sent to a robot.
enum class TableLimit {
  position,     ///< the position limits of the joint
  step,         ///< the largest step from row to row
  range,        ///< the range of the encoder's counts
  torque,       ///< the peak torque of the motor
  start_speed,  ///< the speed of the first rows
  end_speed,    ///< the speed of the last rows
};
/// The name of the limit in files: "position", "step", ...
const char* name_of(TableLimit limit);

/// One way in which a table is unsafe, with its worst row.
struct SafetyViolation {
  TableLimit kind = TableLimit::position;  ///< the limit that is violated
  std::string joint;
  double t = 0;                 ///< time of the worst row [s]
  double value = 0, limit = 0;  ///< value and limit, in `unit`
  std::string unit;             ///< "rad", "counts", "rad/s", "N m"
  int rows = 0;                 ///< number of rows that violate this limit
  double begin = 0, end = 0;    ///< window of the violation in the time of the table [s]
};

/// A time of a table together with the time of the pattern: "3.234 s (1.234 s of the pattern)", or
/// "1.234 s (in the ramp)" before `begin` and "9.500 s (in the hold)" after `end`.
std::string on_both_clocks(double t, double begin, double end);

/// A violation in words, such as "l_knee at 3.234 s (1.234 s of the pattern): step 61 counts, limit
/// 57 (3 rows)".
std::string text_of(const SafetyViolation& violation, bool degrees = true);

struct SafetyReport {
  bool safe = true;
  double ramp = 0, hold = 0;    ///< durations of the ramp and the hold around the motion [s]
  double motion = 0;            ///< duration of the motion between them [s]
  double max_step_ratio = 0;    ///< largest step as a share of the step that one tick allows
  std::string worst_joint;      ///< joint with max_step_ratio
  double worst_at = 0;          ///< its time [s]
  double min_limit_margin = 0;  ///< smallest distance from the soft position limits [rad]
  std::string margin_joint;     ///< joint with min_limit_margin
  double start_speed = 0, end_speed = 0;    ///< speed of the fastest joint at the ends [rad/s]
  std::vector<SafetyViolation> violations;  ///< worst violation of each kind and joint
  /// All violations, by joint and time, except those of torques.
  std::vector<SafetyViolation> rows;
};

struct SafeTable {
  /// Ramp + motion + hold; in ramp and hold, all values except theta are those of the first and the
  /// last row.
  ReferenceTrajectory table;
  size_t first = 0;  ///< row of the table where the motion begins
  SafetyReport report;
};

/// Adds ramp and hold to the motion and judges the result. The ramp has minimum jerk and is so long
/// that no joint exceeds half its speed limit. Throws Error(bad_pattern) if there are no rows, if
/// the joints are not those of the robot, if an angle is not finite, or if the ramp would last for
/// more than an hour. Throws Error(usage) for a ramp or a hold outside kRest, and Error(bad_model)
/// for an unknown posture or profile.
SafeTable make_safe(const RobotModel& model, ReferenceTrajectory reference,
                    const SafetyOptions& options = {});

/// The servo targets of a table, row by row. The table itself need not exist.
struct TargetRows {
  double dt = 0.001;                ///< time from row to row [s]
  std::vector<std::string> joints;  ///< joints in the order of the targets
  size_t count = 0;
  std::function<void(size_t row, Eigen::VectorXd& theta)> row;  ///< fills in the targets of a row
};

/// The report of make_safe() for a table with these targets, which needs no memory for them. If
/// make_safe() would refuse the ramp because it is too long, the steps of a short ramp are
/// violations.
SafetyReport safety_of_targets(const RobotModel& model, const TargetRows& targets,
                               const SafetyOptions& options = {});

/// Finds where motor torques exceed the peaks of a profile, and returns the worst of every joint.
/// The torques have one row for each row of the table (rows x dof of the robot); the first one is
/// at `begin` [s] of the table. A table contains no forces, but a log does.
std::vector<SafetyViolation> torque_violations(const RobotModel& model,
                                               const Eigen::MatrixXd& torque, double dt,
                                               double begin, const std::string& profile);

/// Adds violations to the report of a table, which is then unsafe.
void add_violations(SafeTable& safe, const std::vector<SafetyViolation>& violations);

/// The table that a robot should receive from a run: make_safe(), and the torques that the motors
/// gave in the run (rows of `reference` x dof), judged by the same profile.
SafeTable make_safe_run(const RobotModel& model, const ReferenceTrajectory& reference,
                        const Eigen::MatrixXd& torque, const SafetyOptions& options);

/// The angles to which a joint of this unit may be sent [rad] or [m].
struct TargetRange {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// The range in which the joint, and the reading of its encoder, keep `margin` [rad, m] from the
/// position limits. Motor boards do not know the zeros of a unit: they keep the counts within the
/// limits of the type (HOAP-3 manual, S.2.2, setting N). The range is infinite for a joint without
/// limits.
TargetRange target_range(const Dof& dof, double zero, double margin);

/// The encoder counts of every row, rows x dof in the robot's joint order, with the encoder zeros
/// of the profile of the options. A count is the nearest whole number, or its neighbour (less than
/// one count off) if only this neighbour keeps the position limits and count_step_limits(). Joints
/// without an encoder give 0.
Eigen::MatrixXi encoder_counts(const RobotModel& model, const ReferenceTrajectory& table,
                               const SafetyOptions& options);

/// The largest step in a tick of `dt` [s], by dof, in whole counts: the smaller one of the motor
/// board's limit and the profile's speed limit, rounded down. It is infinite for joints without an
/// encoder.
Eigen::VectorXd count_step_limits(const RobotModel& model, double dt, const SafetyOptions& options);

/// The largest step in a tick of every joint in [rad] or [m]. For a joint without an encoder, only
/// the profile's speed limit counts.
Eigen::VectorXd largest_steps(const RobotModel& model, double dt, const SafetyOptions& options);

}  // namespace ayumi
