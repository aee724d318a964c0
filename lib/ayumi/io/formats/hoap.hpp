#pragma once
// HOAP sequence files, which the motion program of Fujitsu's HOAP robots plays. They have one row
// per frame,
//   <interval ms>,2,<motor 1>,...,<motor n>[,<words>],R,...
// without a head row. Motors are in device order, values are encoder counts, and the interval is
// the time to the next row. "R" requests sensor data. The columns are those of a layout of the
// robot's sidecar; files without an interval are recordings of a robot.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/limits/table_safety.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

/// The robot's layouts. A sidecar without any layout has three. The first has the interval, 2, the
/// motors of all encoders and three requests. The other two have no interval: one has the counts of
/// the motors and two more values, the other has the angles of the motors [rad] and two more
/// values.
std::vector<SequenceLayout> sequence_layouts(const RobotModel& model);

/// The layout with this name; without a name, the first one with an interval. Tables are written in
/// this layout. Throws Error(bad_model) if there is no such layout, or if the robot does not have
/// each of its devices once.
SequenceLayout written_layout(const RobotModel& model, const std::string& name = "");

/// One row with a value for every motor.
struct HoapRow {
  int at = 0;  ///< time from the first row of the file [ms]
  /// Values by device, from device 1 on: counts, or radians if the layout says so.
  std::vector<double> values;
};

/// The content of a sequence file.
struct HoapFile {
  SequenceLayout layout;
  std::vector<HoapRow> rows;
  int tick_ms = 1;           ///< greatest common divisor of the intervals between rows [ms]
  bool even = true;          ///< all these intervals are equal
  int general_commands = 0;  ///< number of rows with commands to one device
  /// Text after the motors of the first and the last row, as written.
  std::string first_words, last_words;
  std::string line_end = "\n";  ///< end of the first line

  double dt() const { return 0.001 * tick_ms; }
};

/// Blanks, CR, `-0` and any text after the motors are accepted. If the rows state no interval, it
/// is that of their layout, or `interval_ms` if this is above 0. Throws Error(bad_file) "file:line:
/// ..." if no layout of the robot has this number of columns, if a value is not a count of 16 bits
/// (or not an angle), if an interval is not a positive whole number, and if there are no rows.
HoapFile parse_hoap(const std::string& bytes, const std::string& file, const RobotModel& model,
                    int interval_ms = 0);

/// Whether the beginning of a file looks like a sequence of this robot.
bool looks_like_hoap(const std::string& bytes, const RobotModel& model);

/// Values of one device (counted from 1) at every tick, interpolated linearly between rows.
Eigen::VectorXd values_on_ticks(const HoapFile& sequence, int device);

/// Angle of a joint per unit of the file's values. Radians have the sign of the encoder.
double angle_of_unit(const HoapFile& sequence, const Dof& dof);

/// The readings of the encoders (model/encoder_angles) at the ticks of a sequence, ticks x dof in
/// the robot's joint order. The encoders of joints without a device in the file read their home
/// angle.
Eigen::MatrixXd hoap_readings(const RobotModel& model, const HoapFile& sequence);

/// The servo targets of a sequence at its ticks, as angles of the joints of this robot unit, in the
/// robot's joint order; the other fields are zero.
ReferenceTrajectory hoap_targets(const RobotModel& model, const HoapFile& sequence);

/// Why a sequence of this layout cannot have a row every `dt` [s]; empty if it can.
std::string refusal_of_interval(const RobotModel& model, const SequenceLayout& layout, double dt);

/// The table as a sequence file, in the layout of written_layout() unless another one is given. The
/// counts are those of encoder_counts under the step limits of the options. Throws
/// Error(bad_pattern) for a dt with a refusal_of_interval(), or if a count does not fit into 16
/// bits.
std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options = {});
std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options, const SequenceLayout& layout);

/// An imported sequence as it was, with a ramp and a hold around it in the form of the sequence.
/// The rows of `table` before row `first` come before the sequence, and the rows from `first` +
/// `count` on come after it.
std::string hoap_csv_around(const RobotModel& model, const ReferenceTrajectory& table, size_t first,
                            size_t count, const SafetyOptions& options, const HoapFile& sequence,
                            const std::string& bytes);

}  // namespace ayumi
