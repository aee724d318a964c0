#pragma once
// Recordings of a robot: the angles that were sent to it, the angles that it measured, and its load
// cells and IMU. They are HOAP files (counts without a head row) or tables with column names.

#include <string>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct RecordingOptions {
  bool degrees = false;  ///< the unit of joint columns whose names have none
  double rate = 0;       ///< rows per second if the file has no times [1/s]; 0 for 1000
  MeasuredAt measured_at = MeasuredAt::encoder;
};

/// Reads the angles of the joints of this robot unit from a HOAP sequence (interval, 2, counts,
/// ...), rows of counts (one column for each device, further columns are 0), or a table with a head
/// row: t[s] or time[s], and joints as theta.<joint>[rad], <joint>, <joint>[rad], <joint>[deg] or
/// <joint>[counts]; other columns are ignored. Throws Error(bad_file) "file:line: ..." or "file:
/// column '...': ..." for a text that is not such a table, line ends of two kinds, values that are
/// not numbers, gaps in time, jumps that no motor makes (missing samples, counters that wrap),
/// angles in another unit, a device that moves but has no joint, a table in which all values
/// are zero, or a rate beyond kRecordingRate; Error(usage) for such a rate in the options.
AngleTable read_angles(const std::string& bytes, const std::string& file, const RobotModel& model,
                       const RecordingOptions& options = {});

/// Makes angles that were measured at the encoders or at the joints into angles of joints, as
/// read_angles() does. Columns that the table does not have are left as they are.
void take_to_joints(const RobotModel& model, MeasuredAt measured_at, AngleTable& table);

/// Whether the first row of a file is numbers, as HOAP files are.
bool is_bare_table(const std::string& bytes);

/// Whether a file holds load cells or an IMU but no angles. Such a file has named columns of these
/// sensors. Or it has bare rows with more than two columns beyond the robot's devices, and the
/// sidecar says how to read them.
bool holds_sensors(const std::string& bytes, const std::string& file, const RobotModel& model);

/// Reads load cells and IMU. They are rows of readings, which the sidecar's `load_cells`,
/// `accelerometer` and `gyro` convert into forces and rates, or a table with a head row and the
/// columns fz.left[N] and fz.right[N] (or left and right), acc.x[m/s^2], gyro.x[rad/s], .... Throws
/// the same errors as read_angles().
SensorTable read_sensors_table(const std::string& bytes, const std::string& file,
                               const RobotModel& model, const RecordingOptions& options = {});

}  // namespace ayumi
