#include "ayumi/sim/tilt_estimate.hpp"

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kBiasTime = 4 * kTiltTime;  // both poles of the loop are real then

}  // namespace

void TiltEstimate::start(const Quaterniond& attitude, const Vector3d& gyro) {
  started_ = true;
  attitude_ = attitude;
  bias_ = gyro;
  rate_.setZero();
}

// The force is compared with gravity as a vector and not by its direction: in flight, where there
// is none, nothing is corrected, and what walking adds and takes has no mean.
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
