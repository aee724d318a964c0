#pragma once
// HOAP sequence files: what the motion program of Fujitsu's HOAP robots plays, one row per frame,
//   <interval ms>,2,<motor 1>,...,<motor n>[,<RC words>],R,...
// without a head row. Motors in device order, values in encoder counts, interval = time to the next
// row. "R" requests sensor data. HOAP-1 has 20 motors and three boards: 25 columns.

#include <filesystem>
#include <string>

#include "ayumi/check/table_safety.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

/// Columns of a sequence file behind the interval and the command word.
struct HoapLayout {
  int motors = 20;
  int rc_words = 0;  ///< hobby servo boards between motors and requests
  int requests = 3;  ///< "R" at the end
  int columns() const { return 2 + motors + rc_words + requests; }
};

/// Counts as a file holds them, rows x motors in device order.
struct HoapSequence {
  int interval_ms = 1;
  Eigen::MatrixXi counts;
};

/// Throws Error(bad_file) "file:line: ..." for a row of another length, a command other than 2, a
/// cell that is not a whole 16-bit number, intervals that change, no rows. Blanks and CR are fine.
HoapSequence parse_hoap(const std::string& bytes, const std::string& file,
                        const HoapLayout& layout);
std::string hoap_text(const HoapSequence& sequence, const HoapLayout& layout);

/// Layout of this robot. Throws Error(bad_model) when its joints have no encoder devices 1..n.
HoapLayout hoap_layout(const RobotModel& model);

/// The table as a sequence file; counts by encoder_counts under the options' step limits. Throws
/// Error(bad_pattern) when dt is not whole milliseconds or a count leaves 16 bits.
std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options = {});

/// Joint angles of a sequence file (other fields zero), in the robot's joint order. Throws as
/// parse_hoap.
ReferenceTrajectory read_hoap(const std::filesystem::path& path, const RobotModel& model);

}  // namespace ayumi
