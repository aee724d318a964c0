#include "ayumi/sim/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

/// Square root of the number of readings that the IMU averages at rest before the start. Chosen:
/// 400 readings are 0.4 s, for which the robot holds its first posture. Its effect is in
/// constants.md.
constexpr double kRestRoot = 20;

}  // namespace

Sensors::Sensors(const RobotModel& model, const ActuatorLimits& actuators, double dt, bool noise,
                 std::uint64_t seed)
    : model_(&model),
      offset_(Eigen::VectorXd::Zero(model.dof_count())),
      counts_(offset_.size()),
      imu_(std::max(0, model.find_link(model.description().sensors.imu_link))),
      dt_(dt),
      noise_(noise),
      random_(seed) {
  const SensorDescription& s = model.description().sensors;
  if (noise) {
    const auto ticks = [&](const std::optional<double>& latency) {
      return static_cast<size_t>(std::lround(latency.value_or(s.latency) / dt));
    };
    encoder_latency_ = ticks(s.encoder_latency);
    imu_latency_ = ticks(s.imu_latency);
    force_latency_ = ticks(s.force_latency);
    for (const Side side : {Side::left, Side::right})
      cells_[static_cast<size_t>(side)] = load_cells(model, side);
  }
  latency_ = std::max({encoder_latency_, imu_latency_, force_latency_});
  ring_.resize(latency_ + 1);
  for (Eigen::Index j = 0; j < offset_.size(); ++j)
    offset_[j] = actuators.servo[static_cast<size_t>(j)].offset;
  for (Eigen::Index j = 0; j < counts_.size(); ++j)
    counts_[j] =
        std::abs(model.dofs()[static_cast<size_t>(j)].encoder.counts_per_degree) * 180.0 / M_PI;
}

void Sensors::reach_back(double latency) {
  const size_t size = latency_ + static_cast<size_t>(std::lround(latency / dt_)) + 1;
  if (size <= ring_.size()) return;
  // Moves the oldest reading to the front, so that the newest is the last one in the filled part.
  std::rotate(ring_.begin(), ring_.begin() + static_cast<long>((newest_ + 1) % ring_.size()),
              ring_.end());
  std::rotate(ring_.begin(), ring_.end() - static_cast<long>(filled_), ring_.end());
  newest_ = filled_ ? filled_ - 1 : 0;
  ring_.resize(size);
}

void Sensors::measure(const RobotState& state, const RobotData& truth, const StepReport& report,
                      const SensorFault& fault, const std::vector<JointFault>& faults,
                      Measurement& m) {
  const SensorDescription& s = model_->description().sensors;
  if (noise_) draw_numbers(report);
  // Encoders are on the motors, in front of their gears.
  m.theta = (report.motor.size() > 0 ? report.motor : state.theta) - offset_;
  for (size_t j = 0; j < faults.size(); ++j)
    m.theta[static_cast<Eigen::Index>(j)] += faults[j].encoder;
  if (noise_ && s.encoder_quantisation) {
    for (Eigen::Index j = 0; j < counts_.size(); ++j)
      if (counts_[j] > 0) m.theta[j] = std::round(m.theta[j] * counts_[j]) / counts_[j];
  }
  // Rates are differences of successive readings. Without noise they are exact, because the
  // integrator moves joints by rate times step.
  if (previous_theta_.size())
    m.dtheta = (m.theta - previous_theta_) / dt_;
  else
    m.dtheta = report.motor_rate.size() > 0 ? report.motor_rate : state.dtheta;
  previous_theta_ = m.theta;

  measure_imu(truth, fault, m);
  for (int side = 0; side < 2; ++side) {
    const std::vector<SoleForce>& cells = report.soles[side];
    const Sole& sole = model_->sole(static_cast<Side>(side));
    const Eigen::Matrix3d to_sole =
        sole_pose(*model_, truth, static_cast<Side>(side)).linear().transpose();
    FootLoad& load = m.feet[side];
    load.fz = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    std::vector<LoadCell>& response = cells_[static_cast<size_t>(side)];
    for (size_t i = 0; i < cells.size(); ++i) {
      double f = (to_sole * cells[i].force).z();
      if (!response.empty()) f = response[i].felt(f);
      if (noise_) {
        f += s.force_noise * numbers_[used_++];
        if (s.force_resolution > 0) f = std::round(f / s.force_resolution) * s.force_resolution;
      }
      f = std::max(f + fault.force, 0.0);
      if (!response.empty()) f = response[i].reported(f);
      load.fz += f;
      moment += f * sole.polygon[i];
    }
    load.cop = load.fz > 0 ? Eigen::Vector2d(moment / load.fz) : sole.center;
  }
}

// Draws all random numbers of a reading at once, in the order in which they are used.
void Sensors::draw_numbers(const StepReport& report) {
  size_t vectors = 2;  // vectors for gyro and attitude
  if (model_->description().sensors.accelerometer_noise > 0) vectors += tilt_.started() ? 1 : 3;
  numbers_.resize(3 * vectors + report.soles[0].size() + report.soles[1].size());
  random_.normals(numbers_.data(), static_cast<int>(numbers_.size()));
  used_ = 0;
}

Vector3d Sensors::noise(double sigma) {
  const Eigen::Map<const Vector3d> numbers(&numbers_[used_]);
  used_ += 3;
  // The first number belongs to z. Published tables were made with this order, so it must not
  // change.
  return sigma * numbers.reverse();
}

Vector3d Sensors::specific_force(const RobotData& truth, const Eigen::Quaterniond& attitude) {
  const Link& link = model_->links()[imu_];
  const Vector3d arm =
      truth.rotation[link.body] * (link.pose * model_->description().sensors.imu_position);
  const Vector3d velocity =
      truth.velocity[link.body] + truth.angular_velocity[link.body].cross(arm);
  const Vector3d acceleration = (velocity - imu_velocity_) / dt_;
  imu_velocity_ = velocity;
  return attitude.conjugate() * (acceleration + Vector3d(0, 0, kGravity));
}

void Sensors::measure_imu(const RobotData& truth, const SensorFault& fault, Measurement& m) {
  const SensorDescription& s = model_->description().sensors;
  const Link& link = model_->links()[imu_];
  Eigen::Quaterniond attitude(Eigen::Matrix3d(truth.rotation[link.body] * link.pose.linear()));
  m.gyro = attitude.conjugate() * truth.angular_velocity[link.body] + fault.gyro;
  if (noise_) {
    m.gyro += noise(s.gyro_noise);
    if (s.accelerometer_noise > 0) {
      const Vector3d force = specific_force(truth, attitude) + noise(s.accelerometer_noise);
      // The unit is switched on while the robot rests, and averages its readings before the start.
      if (tilt_.started()) {
        tilt_.update(m.gyro, force, dt_);
      } else {
        const Vector3d level = noise(s.accelerometer_noise / kGravity / kRestRoot);
        tilt_.start(exp_rotation({level.x(), level.y(), 0}) * attitude,
                    fault.gyro + noise(s.gyro_noise / kRestRoot));
      }
      attitude = tilt_.attitude();
    }
    Vector3d error = noise(s.attitude_noise);
    error.head<2>().array() += s.attitude_bias;
    attitude = exp_rotation(error) * attitude;
  }
  if (!fault.tilt.isZero(0))
    attitude = exp_rotation({fault.tilt.x(), fault.tilt.y(), 0}) * attitude;
  m.attitude = attitude.normalized();
}

const Measurement& Sensors::read(const RobotState& state, const RobotData& truth,
                                 const StepReport& report, const SensorFault& fault,
                                 const std::vector<JointFault>& faults) {
  newest_ = filled_ ? (newest_ + 1) % ring_.size() : 0;
  measure(state, truth, report, fault, faults, ring_[newest_]);
  filled_ = std::min(filled_ + 1, ring_.size());
  const auto added = static_cast<size_t>(std::lround(fault.latency / dt_));
  if (encoder_latency_ == latency_ && imu_latency_ == latency_ && force_latency_ == latency_)
    return before(latency_ + added);
  const Measurement& joints = before(encoder_latency_ + added);
  const Measurement& imu = before(imu_latency_ + added);
  together_.theta = joints.theta;
  together_.dtheta = joints.dtheta;
  together_.attitude = imu.attitude;
  together_.gyro = imu.gyro;
  together_.feet = before(force_latency_ + added).feet;
  return together_;
}

const Measurement& Sensors::before(size_t ticks) const {
  return ring_[(newest_ + ring_.size() - std::min(ticks, filled_ - 1)) % ring_.size()];
}

}  // namespace ayumi
