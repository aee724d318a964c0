#pragma once
// The robot's sensors, computed from the true state of the plant: encoders, IMU, and load cells at
// the corners of each sole. With noise, they have the sidecar's noise, bias, resolution and
// latency, and load cells have the errors that are stated for them. An IMU whose accelerometer
// noise is given estimates its attitude with TiltEstimate.

#include <array>
#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/sim/load_cell.hpp"
#include "ayumi/sim/schedule.hpp"
#include "ayumi/sim/step.hpp"
#include "ayumi/sim/tilt_estimate.hpp"

namespace ayumi {

class Sensors {
 public:
  Sensors(const RobotModel& model, const ActuatorLimits& actuators, double dt, bool noise,
          std::uint64_t seed);

  /// The measurement after a plant step. `truth` has the positions and velocities of `state`, and
  /// the report has the forces of this step. `faults` is by dof, or empty. The result is valid
  /// until the next reading.
  const Measurement& read(const RobotState& state, const RobotData& truth, const StepReport& report,
                          const SensorFault& fault = {},
                          const std::vector<JointFault>& faults = {});

  /// Keeps as many readings as an additional latency up to `latency` needs [s].
  void reach_back(double latency);

 private:
  void measure(const RobotState& state, const RobotData& truth, const StepReport& report,
               const SensorFault& fault, const std::vector<JointFault>& faults, Measurement& m);
  void measure_imu(const RobotData& truth, const SensorFault& fault, Measurement& m);
  void draw_numbers(const StepReport& report);
  /// The reading that is `ticks` older than the newest, or else the very first one.
  const Measurement& before(size_t ticks) const;
  Eigen::Vector3d noise(double sigma);
  /// The mean specific force at the IMU since the last reading, in IMU axes [m/s^2].
  Eigen::Vector3d specific_force(const RobotData& truth, const Eigen::Quaterniond& attitude);

  const RobotModel* model_;
  Eigen::VectorXd offset_;  // offsets of the encoders [rad, m]
  Eigen::VectorXd counts_;  // counts per rad; 0: unknown
  int imu_;                 // link of the IMU
  double dt_;
  bool noise_;
  Random random_;
  std::vector<double> numbers_;  // normal random numbers of one reading
  size_t used_ = 0;              // number of those that are already used
  Eigen::VectorXd previous_theta_;
  TiltEstimate tilt_;
  Eigen::Vector3d imu_velocity_ =
      Eigen::Vector3d::Zero();  // velocity at the last reading, in the world [m/s]
  // The latencies of the robot's own joint angles, of its IMU and of its load cells, and the
  // longest of these [ticks].
  size_t encoder_latency_ = 0, imu_latency_ = 0, force_latency_ = 0, latency_ = 0;
  std::array<std::vector<LoadCell>, 2> cells_;  // cells by Side and corner; empty: exact cells
  // Readings for the longest latency + 1 ticks; the newest is at newest_.
  std::vector<Measurement> ring_;
  size_t newest_ = 0, filled_ = 0;
  Measurement together_;  // a measurement that combines readings of different ages
};

}  // namespace ayumi
