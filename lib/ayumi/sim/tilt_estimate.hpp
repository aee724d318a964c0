#pragma once
// The attitude that an inertial unit computes from its gyro and accelerometer.
// docs/theory_plant.md, "Tilt".

#include <Eigen/Geometry>

namespace ayumi {

/// A complementary filter: the attitude follows the gyro over times shorter than kTiltTime and the
/// direction of gravity over longer times. The heading only follows the gyro.
class TiltEstimate {
 public:
  /// Starts at rest with this attitude; `gyro` is the gyro's mean reading at rest [rad/s].
  void start(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& gyro);
  bool started() const { return started_; }

  /// Takes readings in the axes of the unit: the present rate [rad/s], and the mean specific force
  /// of the last `dt` [s] [m/s^2]. If the unit is not accelerated, this force is gravity with
  /// reversed sign.
  void update(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt);

  /// Rotation from the unit to the world.
  const Eigen::Quaterniond& attitude() const { return attitude_; }
  const Eigen::Vector3d& gyro_bias() const { return bias_; }  ///< bias of the gyro [rad/s]

 private:
  bool started_ = false;
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();
};

/// Time constant with which gravity corrects the attitude [s]. Chosen: several steps of a walk,
/// whose accelerations have no mean, and short against the drift of a gyro. Its effect is in
/// constants.md.
constexpr double kTiltTime = 5.0;

}  // namespace ayumi
