#pragma once
// The command that a robot received and the angles that it measured, by joint, with common times.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ayumi {

/// Joint angles at a fixed rate. Row k is at time k dt.
struct AngleTable {
  double dt = 0.001;      ///< [s]
  Eigen::MatrixXd theta;  ///< rows x dof [rad, m]
  std::vector<char> has;  ///< by dof: the file has this joint
  bool timed = false;     ///< the file says when each row was
  /// Step of the values of each dof, 0 where they are not rounded [rad, m].
  Eigen::VectorXd resolution;

  double duration() const { return dt * static_cast<double>(theta.rows() - 1); }
};

/// What a robot measured in addition to its joint angles. Vectors that the file does not have are
/// empty.
struct SensorTable {
  double dt = 0.001;                   ///< [s]
  Eigen::MatrixXd foot_load;           ///< rows x (left, right) [N], of the file's own calibration
  Eigen::MatrixXd acceleration, gyro;  ///< rows x (x, y, z) [m/s^2, rad/s]
  bool timed = false;                  ///< the file says when each row was
};

struct RecordedMotion {
  AngleTable command, measured;
  SensorTable sensors;
};

}  // namespace ayumi
