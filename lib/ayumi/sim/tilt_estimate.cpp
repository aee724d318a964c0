#include "ayumi/sim/tilt_estimate.hpp"

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

/// Time constant of the gyro's bias [s]. Derived: with 4 kTiltTime, both poles of the loop are
/// equal and real, so that the estimate does not overshoot.
constexpr double kBiasTime = 4 * kTiltTime;

}  // namespace

void TiltEstimate::start(const Quaterniond& attitude, const Vector3d& gyro) {
  started_ = true;
  attitude_ = attitude;
  bias_ = gyro;
  rate_.setZero();
}

// The force enters as a vector and not as a direction: in flight, where it is zero, nothing is
// corrected, and the accelerations of a walk have no mean effect.
void TiltEstimate::update(const Vector3d& gyro, const Vector3d& force, double dt) {
  const Vector3d rate = gyro - bias_;
  attitude_ = (attitude_ * exp_rotation(0.5 * dt * (rate_ + rate))).normalized();
  rate_ = rate;
  const Vector3d up = attitude_.conjugate() * Vector3d::UnitZ();
  const Vector3d error = (force / kGravity).cross(up);
  attitude_ = (attitude_ * exp_rotation(dt / kTiltTime * error)).normalized();
  bias_ -= dt / (kTiltTime * kBiasTime) * error;
}

}  // namespace ayumi
