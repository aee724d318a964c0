#pragma once
// The stabilised reference that a robot replays: servo targets row by row, and the quantities from
// which they were computed. io writes it as CSV, JSON or HOAP pulses.

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "ayumi/model/robot_state.hpp"

namespace ayumi {

struct Provenance {
  std::string robot, robot_sha256, pattern, pattern_sha256, profile, controller, command_line;
};

/// The servo that a table was made for.
struct TableServo {
  std::string content;  ///< "ideal" (the posture), "lead" or "lead+sag"; "" if it is not known
  std::string profile;  ///< profile to which the servo belongs
  /// The transport delay, and the time by which a joint is behind its target [s]. Each is one
  /// number for all joints, or one per joint in the order of the columns.
  std::string delay, lag;
  /// The zeros of the encoders of the unit that receives the table (model/encoder_angles), in the
  /// order of the columns [rad, m]; empty if they are not known. Files hold encoder angles, and the
  /// rows of a ReferenceTrajectory hold joint angles.
  Eigen::VectorXd zeros = {};
};

struct ReferenceRow {
  Eigen::VectorXd theta;  ///< servo targets as joint angles, in the order of the joints [rad]
  BasePose base;          ///< planned or reference base in the world
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< COG in the world [m]
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();  ///< ZMP in the world [m]
  double fz = 0;                                  ///< vertical force [N]
  std::array<bool, 2> contact = {true, true};     ///< contact of the left and the right foot
};

struct ReferenceTrajectory {
  double dt = 0.001;                ///< time between rows [s]
  std::vector<std::string> joints;  ///< names of the columns of theta
  std::vector<ReferenceRow> rows;   ///< rows, of which row k is at k dt
  Provenance provenance;
  TableServo servo = {};
};

/// The table with rows every `dt` [s], interpolated linearly between its rows. If the last row is
/// not on one of the new ticks, it follows as one more row. Throws Error(usage) if `dt` is not
/// above 0 or gives too many rows (4e6).
ReferenceTrajectory resampled(const ReferenceTrajectory& table, double dt);

}  // namespace ayumi
