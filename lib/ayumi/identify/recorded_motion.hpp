#pragma once
// The command that a robot received and the angles that it measured, by joint, at common times.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

/// Bounds of the rate of a recording. Chosen: a slower recorder misses the motion, and no servo
/// reports its angle more often.
inline constexpr Bounds kRecordingRate = {1, 1e5, "1/s"};
/// The rate [1/s] of rows that are `dt` [s] apart, to a millionth: the clock of a recorder is not
/// more exact, so rows 1.0000000001 s apart have a rate of 1 Hz.
inline double rate_of_rows(double dt) { return std::round(1e6 / dt) / 1e6; }

/// Joint angles at a fixed rate. Row k is at time k dt.
struct AngleTable {
  double dt = 0.001;      ///< time between rows [s]
  Eigen::MatrixXd theta;  ///< joint positions, rows x dof [rad, m]
  std::vector<char> has;  ///< by dof, whether the file has this joint
  bool timed = false;     ///< the file says when each row was measured
  /// Time of the first row by the clock of the file [s]; empty if the file has no time column.
  std::optional<double> clock_start;
  /// Where the angles were measured. `theta` are angles of joints in both cases.
  MeasuredAt measured_at = MeasuredAt::encoder;
  /// The step to which the values of each dof are rounded [rad, m]; 0 if they are not rounded.
  Eigen::VectorXd resolution;

  double duration() const { return dt * static_cast<double>(theta.rows() - 1); }
};

/// Everything that a robot measured in addition to its joint angles. Vectors that the file does not
/// have are empty.
struct SensorTable {
  double dt = 0.001;          ///< time between rows [s]
  Eigen::MatrixXd foot_load;  ///< loads, rows x (left, right) [N], by the file's own calibration
  /// Acceleration and angular velocity, rows x (x, y, z) [m/s^2, rad/s].
  Eigen::MatrixXd acceleration, gyro;
  bool timed = false;  ///< the file says when each row was measured
  /// Time of the first row by the clock of the file [s]; empty if the file has no time column.
  std::optional<double> clock_start;

  Eigen::Index rows() const {
    return std::max({foot_load.rows(), acceleration.rows(), gyro.rows()});
  }
  double duration() const {
    return dt * static_cast<double>(std::max<Eigen::Index>(1, rows()) - 1);
  }
};

/// The value at the time `t` [s] of rows that begin at 0 and are `dt` [s] apart, linearly between
/// two rows. Before the first and after the last row, it is the value of that row.
double interpolated(const Eigen::Ref<const Eigen::VectorXd>& values, double dt, double t);

/// The time from the first row of `angles` to the first row of `sensors` [s]. If both files have a
/// time column and these times overlap for at least half of the shorter file, one clock measured
/// them, and its times count. Otherwise both are taken to begin together, and the result is 0.
double first_row_after(const AngleTable& angles, const SensorTable& sensors);

/// Adds the readings of `more` to `all`, at the times of the rows of `all`. The two begin together
/// or have one clock, as for first_row_after(). If `all` is empty, it becomes `more`. Throws
/// Error(usage) "`file`: ..." if both have readings of the same kind.
void add_sensors(const SensorTable& more, SensorTable& all, const std::string& file);

struct RecordedMotion {
  AngleTable command, measured;
  SensorTable sensors;
};

}  // namespace ayumi
