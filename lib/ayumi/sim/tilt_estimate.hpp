#pragma once
// What an inertial unit makes of its gyro and accelerometer. docs/theory.md, "Tilt".

#include <Eigen/Geometry>

namespace ayumi {

/// Complementary filter: the gyro over times below kTiltTime, gravity above. Heading is the gyro's
/// alone.
class TiltEstimate {
 public:
  /// At rest, with the gyro's mean reading there [rad/s].
  void start(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& gyro);
  bool started() const { return started_; }

  /// With readings in the unit's axes: rate [rad/s] now, specific force [m/s^2] in the mean of the
  /// last `dt` [s]: upwards and as much as gravity where the unit is not accelerated.
  void update(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt);

  const Eigen::Quaterniond& attitude() const { return attitude_; }  ///< unit to world
  const Eigen::Vector3d& gyro_bias() const { return bias_; }        ///< [rad/s]

 private:
  bool started_ = false;
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();
};

constexpr double kTiltTime = 5.0;  ///< of what gravity corrects [s]

}  // namespace ayumi
