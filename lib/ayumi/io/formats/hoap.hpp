#pragma once
// HOAP sequence files: what the motion program of Fujitsu's HOAP robots plays, one row per frame,
//   <interval ms>,2,<motor 1>,...,<motor n>[,<words>],R,...
// without a head row. Motors in device order, values in encoder counts, interval = time to the next
// row. "R" requests sensor data. The columns are those of a layout of the robot's sidecar; files
// without an interval are recordings of a robot.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/limits/table_safety.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

/// The robot's layouts. A sidecar without any has two: interval, 2, the motors of all encoders and
/// three requests; and the motors followed by two more values, without an interval.
std::vector<SequenceLayout> sequence_layouts(const RobotModel& model);

/// The layout of that name, else the first with an interval: the one that is written. Throws
/// Error(bad_model) where there is none, or where the robot does not have each of its devices once.
SequenceLayout written_layout(const RobotModel& model, const std::string& name = "");

/// One row with a value for every motor.
struct HoapRow {
  int at = 0;                  ///< [ms] from the first row of the file
  std::vector<double> values;  ///< by device from 1: counts, or radians where the layout says so
};

/// What a sequence file contains.
struct HoapFile {
  SequenceLayout layout;
  std::vector<HoapRow> rows;
  int tick_ms = 1;           ///< greatest common divisor of the intervals between rows [ms]
  bool even = true;          ///< all these intervals are equal
  int general_commands = 0;  ///< rows with commands to one device
  std::string first_words, last_words;  ///< behind the motors of the first and last row, as written
  std::string line_end = "\n";          ///< of the first line

  double dt() const { return 0.001 * tick_ms; }
};

/// Blanks, CR, `-0` and any text after the motors are accepted. Rows without an interval follow
/// each other in the interval of their layout, or in `interval_ms` where it is above 0. Throws
/// Error(bad_file) "file:line: ..." for a number of columns that no layout of the robot has, a
/// value that is no count of 16 bits (or no angle), an interval that is none, no rows.
HoapFile parse_hoap(const std::string& bytes, const std::string& file, const RobotModel& model,
                    int interval_ms = 0);

/// Whether a file begins as a sequence of this robot.
bool looks_like_hoap(const std::string& bytes, const RobotModel& model);

/// Values of one device (counted from 1) at every tick, interpolated linearly between rows.
Eigen::VectorXd values_on_ticks(const HoapFile& sequence, int device);

/// Angle of a joint per unit of the file's values; radians have the sign of the encoder.
double angle_of_unit(const HoapFile& sequence, const Dof& dof);

/// The servo targets: joint angles of a sequence at its ticks (other fields zero), in the robot's
/// joint order. Joints without a device in the file keep their home angle.
ReferenceTrajectory hoap_targets(const RobotModel& model, const HoapFile& sequence);

/// The table as a sequence file, in the layout that the robot writes unless another is given;
/// counts by encoder_counts under the options' step limits. Throws Error(bad_pattern) when dt is
/// not whole milliseconds or a count leaves 16 bits.
std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options = {});
std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options, const SequenceLayout& layout);

/// An imported sequence as it was, with the rows of `table` before row `first` ahead of it, and
/// those from `first` + `count` behind it: a ramp and a hold in the form of the sequence.
std::string hoap_csv_around(const RobotModel& model, const ReferenceTrajectory& table, size_t first,
                            size_t count, const SafetyOptions& options, const HoapFile& sequence,
                            const std::string& bytes);

}  // namespace ayumi
