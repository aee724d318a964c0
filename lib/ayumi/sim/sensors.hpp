#pragma once
// The robot's own sensors on top of the plant's truth: encoders, IMU, and load cells at the corners
// of each sole, with the sidecar's noise, bias, resolution and latency when asked for. Then the
// attitude of an IMU whose accelerometer noise is given is what it makes of gyro and accelerometer.

#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/sim/schedule.hpp"
#include "ayumi/sim/step.hpp"
#include "ayumi/sim/tilt_estimate.hpp"

namespace ayumi {

class Sensors {
 public:
  Sensors(const RobotModel& model, double dt, bool noise, std::uint64_t seed);

  /// Reads after a plant step: `truth` holds positions and velocities of `state`, the forces are
  /// those of that step. The measurement holds until the next reading.
  /// `faults` by dof, or empty.
  const Measurement& read(const RobotState& state, const RobotData& truth, const StepReport& report,
                          const SensorFault& fault = {},
                          const std::vector<JointFault>& faults = {});

  /// Keeps readings for a further latency of up to this [s].
  void reach_back(double latency);

 private:
  void measure(const RobotState& state, const RobotData& truth, const StepReport& report,
               const SensorFault& fault, const std::vector<JointFault>& faults, Measurement& m);
  void measure_imu(const RobotData& truth, const SensorFault& fault, Measurement& m);
  Eigen::Vector3d noise(double sigma);
  /// Mean of the IMU's specific force since the last reading, its axes [m/s^2].
  Eigen::Vector3d specific_force(const RobotData& truth, const Eigen::Quaterniond& attitude);

  const RobotModel* model_;
  int imu_;  // link
  double dt_;
  bool noise_;
  Random random_;
  Eigen::VectorXd previous_theta_;
  TiltEstimate tilt_;
  Eigen::Vector3d imu_velocity_ = Eigen::Vector3d::Zero();  // at the last reading, world [m/s]
  size_t latency_ = 0;                                      // of the robot's own sensors [ticks]
  std::vector<Measurement> ring_;  // the longest latency + 1 readings, the newest at newest_
  size_t newest_ = 0, filled_ = 0;
};

}  // namespace ayumi
