// If the trunk and the parts that it carries turn while the COG and the soles are held, the other
// parts of the robot move only a little. So L about the COG is taken as the angular momentum of the
// trunk and of all parts that it carries, about their own centre of mass U. A body set of mass m,
// first moment h and second moment J about the base origin that turns with the axis a through p
// has, about u = p_U,
//   sum m_i (r_i - u) x (a x (r_i - p)) = J a - h x (a x p) - u x (a x (h - m p)).
// If the wanted ZMP Z* is outside the support, the missing moment is dL = m g e_z x (Z* - ref Z).
#include "ayumi/control/angular_momentum.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Rate at which the turn of the trunk returns to zero with critical damping, as a multiple of
// omega. Chosen: slower than the DCM, so that the return does not undo the effect of the turn. The
// pushes that the walk of HOAP-1 survives depend little on it: in 32 cases, worst and mean are 1.08
// and 1.52 B, and 1.08 and 1.53 B with 0.7.
constexpr double kReturnRate = 0.5;

// Largest turn of the trunk [rad]: 24 deg. Chosen: the walk of HOAP-1 with hoap1-strong survives
// 1.20 B in the worst of 32 cases; with 0.35 it survives 1.14 B, and with 0.5 a push in the double
// support has this limit, too.
constexpr double kTrunkRange = 0.42;

// Largest tilt of the trunk, which is the sum of the plan's tilt and the turn [rad]: 37 deg.
// Derived: 0.8 is a fall (sim/fall_monitor), and the robot tilts by up to 0.15 more than its
// reference under large pushes that it survives.
constexpr double kTrunkTilt = 0.65;

// Shares of the speed limit and of the peak torque of a joint that the turn may use. Chosen: the
// legs carry the robot with the same motors at the same time. With a quarter of the torque the
// standing robot survives 1.26 B instead of 1.32 B.
constexpr double kSpeedShare = 0.8;
constexpr double kTorqueShare = 0.5;

// Turn [rad] and rate [rad/s] below which the turn counts as zero. Chosen: a hundredth of an
// encoder count of HOAP-1.
constexpr double kReturned = 1e-6;

// Damping of A_G W^-1 A_G', as a share of its trace. Chosen: the effect of a single coordinate
// about its own axis changes by less than a thousandth, and nothing moves for an axis about which
// no coordinate can turn.
constexpr double kMomentumDamping = 1e-4;

std::vector<bool> carried_bodies(const RobotModel& model) {
  const std::vector<Body>& bodies = model.bodies();
  std::vector<bool> carried(bodies.size()), leg(bodies.size());
  for (const Side side : {Side::left, Side::right})
    for (int i = model.sole(side).body; i > 0; i = bodies[static_cast<size_t>(i)].parent)
      leg[static_cast<size_t>(i)] = true;
  for (size_t i = 0; i < bodies.size(); ++i) {
    const bool trunk = static_cast<int>(i) == model.trunk_body();
    carried[i] = trunk || (i > 0 && carried[static_cast<size_t>(bodies[i].parent)] && !leg[i]);
  }
  return carried;
}

Matrix3d about_origin(const Inertia& inertia, const Matrix3d& rotation, const Vector3d& com) {
  return rotation * inertia.about_com * rotation.transpose() +
         inertia.mass * (com.squaredNorm() * Matrix3d::Identity() - com * com.transpose());
}

}  // namespace

AngularMomentumTask::AngularMomentumTask(const RobotModel& model, const ActuatorLimits& limits)
    : model_(&model), carried_(carried_bodies(model)), subtree_(model.bodies().size()) {
  const std::vector<Dof>& dofs = model.dofs();
  for (int j = 0; j < model.dof_count(); ++j) {
    const Body& body = model.bodies()[static_cast<size_t>(dofs[j].body)];
    if (carried_[static_cast<size_t>(dofs[j].body)] && dofs[j].body != model.trunk_body() &&
        !body.prismatic)
      joints_.push_back(j);
  }
  const auto n = static_cast<Eigen::Index>(joints_.size()) + 2;
  weight_.resize(n), speed_.resize(n), torque_.resize(n), rotor_.setZero(n);
  for (const Side side : {Side::left, Side::right}) {  // only the three joints nearest to the trunk
    const std::vector<int>& leg = model.leg(side);
    hips_.insert(hips_.end(), leg.begin(),
                 leg.begin() + std::min<std::ptrdiff_t>(3, std::ssize(leg)));
  }
  double hip_speed = INFINITY, hip_torque = INFINITY;
  for (const int j : hips_) {
    hip_speed = std::min(hip_speed, limits.speed[j]);
    hip_torque = std::min(hip_torque, limits.peak_torque[j]);
  }
  speed_.head<2>().setConstant(kSpeedShare * hip_speed);
  torque_.head<2>().setConstant(kTorqueShare * hip_torque);
  for (Eigen::Index i = 2; i < n; ++i) {
    const int j = joints_[static_cast<size_t>(i) - 2];
    speed_[i] = kSpeedShare * limits.speed[j];
    torque_[i] = kTorqueShare * limits.peak_torque[j];
    rotor_[i] = limits.servo[static_cast<size_t>(j)].rotor_inertia;
  }
  matrix_.setZero(3, n);
  inertia_.setZero(n);
  turn_.setZero(n), rate_.setZero(n), acceleration_.setZero(n);
  low_.setZero(n), high_.setZero(n);
  held_.assign(static_cast<size_t>(n), false);
  weigh(model.joint_weight());
  result_.joints.setZero(model.dof_count());
  result_.joint_rates.setZero(model.dof_count());
}

void AngularMomentumTask::weigh(const VectorXd& weight) {
  double hip_weight = 0;
  for (const int j : hips_) hip_weight = std::max(hip_weight, weight[j]);
  weight_.head<2>().setConstant(hip_weight);
  for (size_t i = 0; i < joints_.size(); ++i)
    weight_[static_cast<Eigen::Index>(i) + 2] = weight[joints_[i]];
}

const Eigen::Matrix3Xd& AngularMomentumTask::matrix(const RobotData& data) {
  const std::vector<Body>& bodies = model_->bodies();
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (!carried_[i]) continue;
    const Inertia& inertia = bodies[i].inertia;
    subtree_[i] = {inertia.mass, inertia.mass * data.com[i],
                   about_origin(inertia, data.rotation[i], data.com[i])};
  }
  const auto trunk = static_cast<size_t>(model_->trunk_body());
  for (size_t i = bodies.size() - 1; i > trunk; --i) {
    if (!carried_[i]) continue;
    SpatialInertia& parent = subtree_[static_cast<size_t>(bodies[i].parent)];
    parent.mass += subtree_[i].mass;
    parent.moment += subtree_[i].moment;
    parent.inertia += subtree_[i].inertia;
  }
  const SpatialInertia& all = subtree_[trunk];
  const Vector3d u = all.moment / all.mass;
  matrix_.setZero();
  inertia_.setZero();
  const Matrix3d central =
      all.inertia - all.mass * (u.squaredNorm() * Matrix3d::Identity() - u * u.transpose());
  matrix_.leftCols<2>() = central.leftCols<2>();
  inertia_.head<2>() = central.diagonal().head<2>();
  for (size_t i = trunk + 1; i < bodies.size(); ++i) {
    if (!carried_[i] || bodies[i].prismatic) continue;
    const auto at = std::find(joints_.begin(), joints_.end(), bodies[i].dof);
    if (at == joints_.end()) continue;
    const Eigen::Index k = at - joints_.begin() + 2;
    const SpatialInertia& s = subtree_[i];
    const Vector3d a = bodies[i].ratio * data.axis[i], &p = data.position[i];
    const Vector3d turned = s.inertia * a - s.moment.cross(a.cross(p));
    const Vector3d momentum = a.cross(s.moment - s.mass * p);
    matrix_.col(k) += turned - u.cross(momentum);
    inertia_[k] += a.dot(turned - p.cross(momentum));
  }
  return matrix_;
}

// Largest rate of a coordinate: the rate from which its torque can stop it at the end of its range.
// A coordinate without a stated torque does not turn, because no such rate is known.
void AngularMomentumTask::bound(const VectorXd& commanded, const Vector2d& tilt,
                                const TurnRoom& room, double dt) {
  for (Eigen::Index i = 0; i < weight_.size(); ++i) {
    if (!std::isfinite(torque_[i])) {
      low_[i] = high_[i] = 0;
      continue;
    }
    double below = -kTrunkRange, above = kTrunkRange;
    if (i < 2) {
      const double other = tilt[1 - i] + turn_[1 - i];
      const double most = std::sqrt(std::max(0.0, kTrunkTilt * kTrunkTilt - other * other));
      below = std::min(0.0, std::max(below, -most - tilt[i]));
      above = std::max(0.0, std::min(above, most - tilt[i]));
      below = std::max(below, turn_[i] - room.below[i]);
      above = std::min(above, turn_[i] + room.above[i]);
    } else {
      const auto j = static_cast<size_t>(joints_[static_cast<size_t>(i) - 2]);
      const Dof& dof = model_->dofs()[j];
      below = std::min(0.0, dof.lower - commanded[static_cast<Eigen::Index>(j)]);
      above = std::max(0.0, dof.upper - commanded[static_cast<Eigen::Index>(j)]);
    }
    const double most = torque_[i] / (inertia_[i] + rotor_[i]);
    const auto speed_with = [&](double left) {
      return std::min(speed_[i], std::sqrt(2 * most * std::max(0.0, left)));
    };
    high_[i] = std::clamp((speed_with(above - turn_[i]) - rate_[i]) / dt, -most, most);
    low_[i] = std::clamp((-speed_with(turn_[i] - below) - rate_[i]) / dt, -most, most);
  }
}

// A coordinate whose acceleration reaches a bound stays at this bound, and the other coordinates
// provide the rest.
void AngularMomentumTask::accelerate(const Vector3d& moment) {
  const Eigen::Index n = weight_.size();
  std::fill(held_.begin(), held_.end(), false);
  acceleration_ = VectorXd::Zero(n).cwiseMax(low_).cwiseMin(high_);
  Vector3d left(moment.x(), moment.y(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    Matrix3d gram = Matrix3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i)
      if (!held_[static_cast<size_t>(i)])
        gram += matrix_.col(i) * matrix_.col(i).transpose() / weight_[i];
    if (!(gram.trace() > 0)) break;
    gram.diagonal().array() += kMomentumDamping * gram.trace();
    const Vector3d y = solve_symmetric(gram, left);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held_[static_cast<size_t>(i)]) continue;
      const double asked = matrix_.col(i).dot(y) / weight_[i];
      acceleration_[i] = std::clamp(asked, low_[i], high_[i]);
      if (acceleration_[i] == asked) continue;
      held_[static_cast<size_t>(i)] = true;
      left -= matrix_.col(i) * acceleration_[i];
      changed = true;
    }
  }
}

const UpperBodyTurn& AngularMomentumTask::update(const Vector3d& moment, const RobotData& data,
                                                 const VectorXd& commanded, const Vector2d& tilt,
                                                 const TurnRoom& room, double omega, double dt) {
  const double back = kReturnRate * omega;
  rate_ -= dt * (back * back * turn_ + 2 * back * rate_);
  if (!moment.isZero(0) || !turn_.isZero(kReturned) || !rate_.isZero(kReturned)) {
    matrix(data);
    bound(commanded, tilt, room, dt);
    accelerate(moment);
    rate_ += dt * acceleration_;
    turn_ += dt * rate_;
  } else {
    rate_.setZero();
    turn_.setZero();
  }
  result_.lean.head<2>() = turn_.head<2>();
  result_.lean_rate.head<2>() = rate_.head<2>();
  for (size_t i = 0; i < joints_.size(); ++i) {
    result_.joints[joints_[i]] = turn_[static_cast<Eigen::Index>(i) + 2];
    result_.joint_rates[joints_[i]] = rate_[static_cast<Eigen::Index>(i) + 2];
  }
  return result_;
}

}  // namespace ayumi
