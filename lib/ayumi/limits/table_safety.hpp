#pragma once
// Before a table goes to a real robot: an approach ramp, an end hold, and a check of what the
// servos would receive, on whole encoder counts where the robot has them. Servos follow every row
// at once, so the table itself has to be safe.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct SafetyOptions {
  std::string profile;        ///< actuator profile of the speed limits; "" = default
  double ramp = 2.0;          ///< least duration of the approach [s]; 0: no ramp
  std::string from = "home";  ///< named posture the robot stands in; "first" = the first row
  double hold = 0.5;          ///< the last row is repeated this long [s]
  double counts_per_ms = 57;  ///< the motor board's own speed cap
  double step_share = 1;      ///< of the largest step that may be used
  /// A target may be beyond the soft limits by this [rad], [m]. Chosen: a hundredth of a count of
  /// HOAP's encoders; a target that leads a start from rest at a limit is beyond it by 4e-9 rad.
  double beyond_range = 1e-6;
  double rest_speed = 0.1;  ///< start and end count as rest below this [rad/s]
  double rest_window = 0;   ///< the speed is a mean over this time; 0: over one row [s]
};

/// The same for an imported sequence whose rows are kept, which is complete as it is: no ramp and
/// no hold, and its speed at both ends is a mean, because its rows are whole counts.
SafetyOptions as_it_is(SafetyOptions options);

/// One way in which a table is unsafe, with its worst row.
struct SafetyViolation {
  std::string kind;  ///< "position", "step", "range", "torque", "start_speed", "end_speed"
  std::string joint;
  double t = 0;                 ///< [s]
  double value = 0, limit = 0;  ///< in `unit`
  std::string unit;             ///< "rad", "counts", "rad/s", "N m"
  int rows = 0;                 ///< how many rows break this limit
  double begin = 0, end = 0;    ///< of the motion, in the time of the table [s]
};

/// A time of a table, with the time of the pattern: "3.234 s (1.234 s of the pattern)", or "1.234 s
/// (in the ramp)" before `begin` and "9.500 s (in the hold)" after `end`.
std::string on_both_clocks(double t, double begin, double end);

/// "l_knee at 3.234 s (1.234 s of the pattern): step 61 counts, limit 57 (3 rows)"
std::string text_of(const SafetyViolation& violation, bool degrees = true);

struct SafetyReport {
  bool safe = true;
  double ramp = 0, hold = 0;                ///< as laid around the motion [s]
  double motion = 0;                        ///< duration of the motion between them [s]
  double max_step_ratio = 0;                ///< step / what one tick allows
  std::string worst_joint;                  ///< of max_step_ratio
  double worst_at = 0;                      ///< [s]
  double min_limit_margin = 0;              ///< to the soft position limits [rad]
  std::string margin_joint;                 ///< of min_limit_margin
  double start_speed = 0, end_speed = 0;    ///< fastest joint at the ends [rad/s]
  std::vector<SafetyViolation> violations;  ///< the worst of each kind and joint
  std::vector<SafetyViolation> rows;        ///< every row, by joint and time, torques apart
};

struct SafeTable {
  ReferenceTrajectory table;  ///< ramp + motion + hold; in ramp and hold everything but theta is
                              ///< that of the first and last row
  size_t first = 0;           ///< row of the table where the motion begins
  SafetyReport report;
};

/// Lays ramp and hold around the motion and judges the result. The ramp is minimum jerk and grows
/// until no joint passes half its speed limit. Throws Error(bad_pattern) for no rows or joints that
/// are not the robot's, Error(bad_model) for an unknown posture or profile.
SafeTable make_safe(const RobotModel& model, ReferenceTrajectory reference,
                    const SafetyOptions& options = {});

/// The servo targets of a table, row by row, where the table itself need not be there.
struct TargetRows {
  double dt = 0.001;                ///< [s]
  std::vector<std::string> joints;  ///< order of the targets
  size_t count = 0;
  std::function<void(size_t row, Eigen::VectorXd& theta)> row;  ///< fills in the targets of a row
};

/// The report of make_safe() for a table with these targets. It takes no memory for them. Where
/// make_safe() refuses the ramp because it is too long, the steps of a short ramp are violations.
SafetyReport safety_of_targets(const RobotModel& model, const TargetRows& targets,
                               const SafetyOptions& options = {});

/// Where motor torques (rows x dof of the robot, the first at `begin` [s] of a table) are beyond
/// the peaks of a profile: the worst of every joint. A table contains no forces; a log does.
std::vector<SafetyViolation> torque_violations(const RobotModel& model,
                                               const Eigen::MatrixXd& torque, double dt,
                                               double begin, const std::string& profile);

/// Adds violations to the report of a table, which is then unsafe.
void add_violations(SafeTable& safe, const std::vector<SafetyViolation>& violations);

/// The table that a robot is to receive from a run: make_safe(), and the torques that its motors
/// gave in the run (rows of `reference` x dof), judged by the same profile.
SafeTable make_safe_run(const RobotModel& model, const ReferenceTrajectory& reference,
                        const Eigen::MatrixXd& torque, const SafetyOptions& options);

/// Encoder counts of every row, rows x dof in the robot's joint order: the nearest whole count, or
/// its neighbour (less than one count off) if only this neighbour keeps the position limits and
/// `step_limits` (counts per tick, by dof). Joints without an encoder give 0.
Eigen::MatrixXi encoder_counts(const RobotModel& model, const ReferenceTrajectory& table,
                               const Eigen::VectorXd& step_limits);

/// Largest step per tick by dof in counts: the least of the motor board's cap and the profile's
/// speed limit; infinite for joints without an encoder.
Eigen::VectorXd count_step_limits(const RobotModel& model, double dt, const SafetyOptions& options);

/// The same for every joint in [rad] or [m]; where the joint has no encoder, by the profile's speed
/// limit alone.
Eigen::VectorXd largest_steps(const RobotModel& model, double dt, const SafetyOptions& options);

}  // namespace ayumi
