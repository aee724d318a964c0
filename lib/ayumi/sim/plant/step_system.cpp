// One step of length h from (q, v), all rates at its end (implicit in servo and contact springs):
//   (M + rotor + h(kd + b) + h^2 kp) v+ = (M + rotor) v + h (kp (target - theta) - bias + ext) + J'
//   l
// solved for the change of velocity: with D, the diagonal of the joints' laws,
//   (M + rotor + D) (v+ - v) = impulses - D v.
#include "ayumi/sim/plant/step_system.hpp"

#include <algorithm>

#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Matrix3d parallel_axis(const Matrix3d& inertia, double mass, const Vector3d& r) {
  return inertia + mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

StepSystem::StepSystem(const RobotModel& model, const ActuatorLimits& actuators, size_t points)
    : factor_(model),
      mass_(factor_.row_doubles()),
      rotor_(model.dof_count()),
      rows_(model, factor_, points),
      diagonal_(static_cast<size_t>(model.dof_count())) {
  for (int j = 0; j < model.dof_count(); ++j) {
    const int place = factor_.place_of(6 + j);
    joint_diagonal_.push_back(static_cast<size_t>(factor_.row_begin(place) + factor_.depth(place)));
    const ServoDescription& servo = actuators.servo[static_cast<size_t>(j)];
    rotor_[j] = servo.kp > 0 && servo.has_gear() ? 0.0 : servo.rotor_inertia;
  }
  zero_ = VectorXd::Zero(model.velocity_count());
  before_ = velocity_ = impulse_ = outside_ = bias_ = change_ = zero_;
}

void StepSystem::set_posture(RobotData& data) {
  std::fill(mass_.begin(), mass_.end(), 0.0);
  data.kernels->mass_entries(data.tree(), data.bodies(), factor_.layout(), mass_.data());
  for (size_t j = 0; j < joint_diagonal_.size(); ++j)
    mass_[joint_diagonal_[j]] += rotor_[static_cast<Eigen::Index>(j)];
}

Matrix3d StepSystem::locked_inertia(const RobotModel& robot, const RobotData& data) const {
  Matrix3d locked;  // inertia about the base origin
  for (int i = 0; i < 3; ++i) {
    const double* row = mass_.data() + factor_.row_begin(factor_.place_of(3 + i));
    for (int j = 0; j <= i; ++j) locked(i, j) = locked(j, i) = row[3 + j];
  }
  return parallel_axis(locked, -robot.mass(), data.cog_offset);
}

void StepSystem::begin(const RobotModel& robot, const RobotState& state, RobotData& data,
                       double dt) {
  newton_euler(robot, state, zero_, data, bias_);
  before_ << state.base_velocity, state.base_angular_velocity, state.dtheta;
  impulse_ = -dt * bias_;
  external_.linear = {0, 0, -dt * robot.mass() * kGravity};
  external_.angular.setZero();
  outside_.setZero();
}

void StepSystem::push(const RobotModel& model, const std::vector<ExternalWrench>& wrenches,
                      const RobotData& data, double dt) {
  for (const ExternalWrench& wrench : wrenches) add_wrench(model, wrench, data, dt);
  if (!wrenches.empty()) impulse_ += outside_;
}

void StepSystem::add_wrench(const RobotModel& model, const ExternalWrench& w, const RobotData& data,
                            double dt) {
  const int body = w.body < 0 ? model.trunk_body() : w.body;
  const Vector3d point = w.body < 0 ? data.cog : w.point;
  const Vector3d p = point - data.base_position;
  const Vector3d force = dt * w.force, torque = dt * w.torque;
  outside_.head<3>() += force;
  outside_.segment<3>(3) += p.cross(force) + torque;
  for (int i = body; i > 0; i = model.bodies()[i].parent) {
    const Body& b = model.bodies()[i];
    outside_[6 + b.dof] +=
        b.ratio * data.axis[i].dot(
                      b.prismatic ? force : Vector3d((p - data.position[i]).cross(force) + torque));
  }
  external_.linear += force;
  external_.angular += torque + (point - data.cog).cross(force);
}

void StepSystem::turn(const Matrix3d& half_turn, const RobotModel& robot, const RobotData& data,
                      std::vector<ActiveContact>& contacts, double dt) {
  turned_ = true;
  half_turn_ = half_turn;
  const Vector3d gravity(0, 0, -kGravity);
  const Vector3d more = dt * (half_turn_.transpose() * gravity - gravity);
  const double mass = robot.mass();
  impulse_.head<3>() += mass * more;
  impulse_.segment<3>(3) += mass * data.cog_offset.cross(more);
  for (size_t j = 0; j < joint_diagonal_.size(); ++j)
    impulse_[6 + static_cast<Eigen::Index>(j)] +=
        Eigen::Map<const Vector3d>(momentum_of_joint(static_cast<int>(j))).dot(more);
  before_.head<3>() = half_turn_.transpose() * before_.head<3>();
  before_.segment<3>(3) = half_turn_.transpose() * before_.segment<3>(3);
  for (ActiveContact& contact : contacts)
    if (contact.other < 0) {
      contact.to_contact = contact.to_contact * half_turn_;
      contact.ground_velocity = half_turn_.transpose() * contact.ground_velocity;
    }
}

bool StepSystem::solve(JointLaws& joints, const RobotData& data, const VectorXd& theta, double dt) {
  joints.start(theta, joint_rates_before(), dt);
  // Each pass changes at least one joint's law.
  for (size_t pass = 0; pass <= JointLaws::kChangesPerJoint * joint_diagonal_.size(); ++pass) {
    if (!solve_once(joints, data, theta, dt)) return false;
    if (!joints.check(theta, joint_rates(), dt)) break;
  }
  return true;
}

bool StepSystem::solve_once(JointLaws& joints, const RobotData& data, const VectorXd& theta,
                            double dt) {
  velocity_ = impulse_;
  joints.add(theta, joint_rates_before(), dt, velocity_.data() + 6, diagonal_);
  solution_ = {};
  bool solved = false;
  if (contact_count_ > 0 && rows_.all_stick()) {
    if (!solve_change(data, Contacts::springs)) return false;
    solved = rows_.take_springs(data, factor_, change_, solution_);
  }
  if (!solved && !solve_change(data, Contacts::rows)) return false;
  for (int k = 0; k < change_.size(); ++k) {
    const int c = factor_.column_at(k);
    velocity_[c] = before_[c] + change_[k];
  }
  return true;
}

// change_ contains the right side at first, then L^-T times it, then also the impulses of the
// contacts, and finally v+ - v.
bool StepSystem::solve_change(const RobotData& data, Contacts contacts) {
  std::vector<double>& system = factor_.rows();
  system = mass_;
  for (size_t j = 0; j < diagonal_.size(); ++j) system[joint_diagonal_[j]] += diagonal_[j];
  for (int k = 0; k < change_.size(); ++k) change_[k] = velocity_[factor_.column_at(k)];
  if (contacts == Contacts::springs) rows_.add_springs(data, factor_, system, change_);
  if (!factor_.factor_rows()) return false;
  factor_.solve_upper(change_);
  if (contacts == Contacts::rows && contact_count_ > 0)
    solution_ = rows_.solve(data, factor_, change_);
  factor_.solve_lower(change_);
  return true;
}

void StepSystem::take_impulses(std::vector<ActiveContact>& contacts, const RobotData& data,
                               double dt, double& work) {
  if (contacts.empty()) return;
  rows_.set_rates(data, factor_, velocity_);
  for (size_t i = 0; i < contacts.size(); ++i) {
    ActiveContact& contact = contacts[i];
    const Vector3d l = rows_.impulse(i), rate = rows_.rate(i);
    contact.impulse = l;
    contact.deflection.setZero();
    if (!(l[0] > 0)) continue;
    const Vector3d motion = rate - contact.to_contact * contact.ground_velocity;
    contact.deflection =
        -l.tail<2>() / (dt * contact.stiffness) - contact.damping_time * motion.tail<2>();
    work += 0.5 * l.dot(rows_.rate_before(i) + rate);
  }
}

}  // namespace ayumi
