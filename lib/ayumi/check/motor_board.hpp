#pragma once
// Processing of a table by the robot: every target becomes a whole count of 16 bits, which the
// motor board keeps within the position limits of the joint's type, in counts of the encoder. The
// board changes its target by at most a given number of counts per millisecond.

#include <string>
#include <vector>

#include "ayumi/limits/table_safety.hpp"

namespace ayumi {

/// A difference between the table and the targets that a joint receives, at its worst sample.
struct Clamp {
  /// What the board limits: the counts to 16 bits, the position, or the change from tick to tick.
  enum class Kind { range, position, speed };
  Kind kind = Kind::range;
  std::string joint;
  double t = 0;       ///< time of the worst sample, from the first row on [s]
  double change = 0;  ///< largest change of the table's value [rad]
  int rows = 0;       ///< number of ticks that differ
};

/// The name of the kind in JSON: "range", "position" or "speed".
const char* name_of(Clamp::Kind kind);

/// Targets as the servos receive them.
struct BoardTargets {
  double dt = 0.001;  ///< tick of the board [s]
  /// Targets as joint angles, dof x ticks, in the robot's order of joints [rad].
  Eigen::MatrixXd targets;
  std::vector<Clamp> clamps;
};

/// The rows of the table as the boards pass them on. Each row holds until the next one. A tick is a
/// millisecond if the interval is a whole number of milliseconds; otherwise it is the interval.
/// Joints without an encoder have no counts: their speed limit is that of the profile of the
/// options. Throws Error(bad_pattern) for a table without rows or with other joints than the
/// robot's.
BoardTargets board_targets(const RobotModel& model, const ReferenceTrajectory& table,
                           const SafetyOptions& options = {});

}  // namespace ayumi
