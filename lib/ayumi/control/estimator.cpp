#include "ayumi/control/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/heading.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

// Time constant of the load share of each foot [s]. Chosen with the prototype: three ticks, enough
// against the noise of the cells and short against a double support of 80 ms. Its effect is in
// constants.md.
constexpr double kLoadFilterTime = 0.003;

// Share of f_z that makes a foot the stance foot. Chosen: from 40 to 60 % of f_z, the stance foot
// does not change, so that the stance does not chatter in a double support; with 0.5 there would be
// no such hysteresis. Its effect is in constants.md.
constexpr double kStanceShare = 0.6;

// Share of the weight below which there is no ZMP: (17) loses its meaning near a flight
// (docs/notation.md). Chosen: half of the smallest force with which a foot counts as standing
// (control/swing_foot). Its effect is in constants.md.
constexpr double kContactShare = 0.05;

// Tilt about x and y of a sole that lies flat, for each unit of f_z (cop - centre) [rad/(N m)]. The
// corners of the sole are springs of equal stiffness, as in the plant (sim/plant/contact_points).
Eigen::Matrix2d tilt_per_moment(const Sole& sole) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  const double count = static_cast<double>(sole.polygon.size());
  for (const Eigen::Vector2d& corner : sole.polygon) middle += corner / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& corner : sole.polygon)
    spread += (corner - middle) * (corner - middle).transpose() / count;
  // Height of the sole over the place r: -r . spread^-1 (cop - centre) f_z / stiffness.
  const Eigen::Matrix2d slope = -spread.inverse() / sole.stiffness;
  Eigen::Matrix2d tilt;  // a slope along y turns about x, one along x about -y
  tilt.row(0) = slope.row(1);
  tilt.row(1) = -slope.row(0);
  return tilt;
}

}  // namespace

Estimator::Estimator(const RobotModel& model, double dt)
    : model_(&model),
      data_(model),
      imu_(std::max(0, model.find_link(model.description().sensors.imu_link))),
      filter_(1.0 - elementary::exp(-dt / kLoadFilterTime)) {
  for (Side side : {Side::left, Side::right}) {
    const int i = static_cast<int>(side);
    sole_[i] = ConvexPolygon(model.sole(side).polygon);
    widest_[i] = sole_[i].margin(model.sole(side).center);
    yield_[i] = tilt_per_moment(model.sole(side));
  }
}

void Estimator::follow_loads(const Measurement& m, const std::array<Isometry3d, 2>& feet) {
  const double weight = model_->mass() * kGravity;
  Estimate& e = last_;
  for (int i = 0; i < 2; ++i) load_[i] += (first_ ? 1.0 : filter_) * (m.feet[i].fz - load_[i]);
  const double total = load_[0] + load_[1];
  if (first_) e.stance = load_[0] >= load_[1] ? Side::left : Side::right;
  if (total > kContactShare * weight)
    for (Side side : {Side::left, Side::right})
      if (load_[static_cast<int>(side)] > kStanceShare * total) e.stance = side;
  e.fz = m.feet[0].fz + m.feet[1].fz;
  e.foot_fz = {m.feet[0].fz, m.feet[1].fz};
  e.contact = e.fz > kContactShare * weight;
  if (e.contact) {
    Vector3d moment = Vector3d::Zero();
    for (int i = 0; i < 2; ++i)
      moment += m.feet[i].fz * (feet[i] * Vector3d(m.feet[i].cop.x(), m.feet[i].cop.y(), 0));
    e.zmp = moment / e.fz;
  }
  first_ = false;
}

const Estimate& Estimator::update(const Measurement& m, const std::array<Isometry3d, 2>& feet) {
  follow_loads(m, feet);
  const double weight = model_->mass() * kGravity;
  Estimate& e = last_;

  // All quantities are first computed in base axes (with the base at the origin and at rest), in
  // one pass over the tree.
  RobotState& s = e.state;
  s.base = BasePose{};
  s.base_velocity.setZero();
  s.base_angular_velocity.setZero();
  s.theta = m.theta;
  s.dtheta = m.dtheta;
  update_velocities(*model_, s, data_);

  // The attitude of the base from the IMU, which may be on any link.
  const Link& imu = model_->links()[imu_];
  const Matrix3d imu_in_base = data_.rotation[imu.body] * imu.pose.linear();
  const Matrix3d R = m.attitude.toRotationMatrix() * imu_in_base.transpose();
  const Vector3d w = m.attitude * m.gyro - R * data_.angular_velocity[imu.body];

  // No sensor measures the heading in the plan frame. The heading of the stance foot is taken from
  // the plan.
  const int stance = static_cast<int>(e.stance);
  const Isometry3d sole_in_base = sole_pose(*model_, data_, e.stance);
  const double yaw = heading_of(feet[stance].linear()) - heading_of(R * sole_in_base.linear());
  const Matrix3d turn = elementary::turn_matrix(yaw, Vector3d::UnitZ());
  s.base.attitude = Quaterniond(Matrix3d(turn * R)).normalized();
  s.base_angular_velocity = turn * w;
  const Matrix3d attitude = s.base.attitude.toRotationMatrix();

  // The loaded point of the sole is at its planned place and at rest.
  const Eigen::Vector2d cop = m.feet[stance].fz > kContactShare * weight
                                  ? m.feet[stance].cop
                                  : model_->sole(e.stance).center;
  const Vector3d local(cop.x(), cop.y(), 0);
  const Vector3d support_in_base = sole_in_base * local;
  const Vector3d support = attitude * support_in_base;
  const Vector3d& rate = s.base_angular_velocity;
  s.base.position = feet[stance] * local - support;
  s.base_velocity =
      -attitude * point_velocity(data_, model_->sole(e.stance).body, support_in_base) -
      rate.cross(support);
  const Vector3d offset = attitude * data_.cog_offset;
  e.cog = s.base.position + offset;
  e.dcog = s.base_velocity + rate.cross(offset) + attitude * data_.dcog;
  const Matrix3d tilt = attitude * sole_in_base.linear() * feet[stance].linear().transpose();
  e.foot_tilt = log_rotation(Quaterniond(tilt));
  Vector3d yielding = Vector3d::Zero();  // tilt of the sole that its load causes
  yielding.head<2>() = yield_[stance] * (m.feet[stance].fz * (cop - model_->sole(e.stance).center));
  e.foot_tilt -= feet[stance].linear() * yielding;
  e.foot_tilt.z() = 0;
  e.stance_inside = std::clamp(sole_[stance].margin(cop) / widest_[stance], 0.0, 1.0);
  return e;
}

}  // namespace ayumi
