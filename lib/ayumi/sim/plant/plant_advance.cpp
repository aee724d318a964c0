// How a step's velocities move the robot. docs/theory_plant.md, "The base" and "Pivoting".
#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/plant.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kOnePoint = 1e-6;   // contacts no further apart are one [m]
constexpr double kStraight = 1e-4;   // contacts no further off a line, in shares of its length
constexpr double kShortPart = 0.02;  // of a step: below, it is not taken in two parts

Matrix3d about(const Matrix3d& inertia, double mass, const Vector3d& r) {
  return inertia + mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

}  // namespace

// Inertia with the joints locked, about the COG.
Matrix3d Plant::locked_inertia() const {
  Matrix3d locked;
  for (int i = 0; i < 3; ++i) {
    const double* row = mass_.data() + factor_.row_begin(factor_.place_of(3 + i));
    for (int j = 0; j <= i; ++j) locked(i, j) = locked(j, i) = row[3 + j];
  }
  return about(locked, -moving().mass(), data_.cog_offset);
}

// A point of the robot, or of the ground under a sole, that stays where it is while the robot
// turns.
bool Plant::is_pivot(const Active& active) const {
  if (active.key >= static_cast<long>(points_.size())) return active.side >= 0;
  const ContactPoint& point = points_[static_cast<size_t>(active.key)];
  return point.radius == 0 && point.rim == 0;
}

void Plant::find_pivot() {
  pivot_.freedom = 0;
  const Vector3d* first = nullptr;
  double farthest = 0;
  for (const Active& active : active_) {
    if (active.other >= 0 || !(active.impulse[0] > 0)) continue;
    if (!is_pivot(active)) return;
    if (!first) {
      first = &active.position;
      continue;
    }
    const Vector3d along = active.position - *first;
    if (along.squaredNorm() <= farthest) continue;
    farthest = along.squaredNorm();
    pivot_.axis = along;
  }
  if (!first) return;
  pivot_.point = *first;
  pivot_.freedom = 3;
  if (farthest <= kOnePoint * kOnePoint) return;
  pivot_.freedom = 0;
  for (const Active& active : active_) {
    if (active.other >= 0 || !(active.impulse[0] > 0)) continue;
    const double off = pivot_.axis.cross(active.position - pivot_.point).squaredNorm();
    if (off > kStraight * kStraight * farthest * farthest) return;
  }
  pivot_.axis.normalize();
  pivot_.freedom = 1;
}

// The rate about the pivot that this momentum gives the robot with its joints locked; forces in the
// pivot give none.
Vector3d Plant::turn_about_pivot(const Momentum& given) const {
  const Vector3d r = data_.cog - pivot_.point;
  const Vector3d moment = given.angular + r.cross(given.linear);
  const Matrix3d inertia = about(locked_inertia(), moving().mass(), r);
  if (pivot_.freedom == 3) return inertia.llt().solve(moment);
  const Vector3d& e = pivot_.axis;
  return e.dot(moment) / e.dot(inertia * e) * e;
}

// The step of a robot that pivots is that of its posture half a step on. All that has turned as one
// keeps its numbers in axes that have turned with it; in these gravity and the ground turn back.
void Plant::turn_half(double dt) {
  turned_ = true;
  half_turn_ = exp_rotation(0.5 * dt * turn_about_pivot(momentum_)).toRotationMatrix();
  const Vector3d gravity(0, 0, -kGravity);
  const Vector3d more = dt * (half_turn_.transpose() * gravity - gravity);
  const double mass = moving().mass();
  impulse_.head<3>() += mass * more;
  impulse_.segment<3>(3) += mass * data_.cog_offset.cross(more);
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double* of_joint = mass_.data() + factor_.row_begin(factor_.place_of(6 + j));
    impulse_[6 + j] += Eigen::Map<const Vector3d>(of_joint).dot(more);
  }
  before_.head<3>() = half_turn_.transpose() * before_.head<3>();
  before_.segment<3>(3) = half_turn_.transpose() * before_.segment<3>(3);
  for (Active& active : active_)
    if (active.other < 0) {
      active.to_contact = active.to_contact * half_turn_;
      active.ground_velocity = half_turn_.transpose() * active.ground_velocity;
    }
}

// When a robot that pivots meets the ground with another point; dt or more when it does not. To be
// asked between solve() and finish().
double Plant::time_of_landing(double dt) const {
  if (pivot_.freedom == 0 || !ground_.at_rest()) return dt;
  double time = dt;
  bool landing = false;
  for (size_t i = 0; i < active_.size(); ++i) {
    const Active& active = active_[i];
    if (active.other >= 0 || active.gap <= 0 || active.impulse[0] > 0) continue;
    if (!(solver_.impulse()[3 * static_cast<Eigen::Index>(i)] > 0)) continue;
    const double approach =
        active.to_contact.row(0).dot(active.ground_velocity) - rates_before_[3 * i];
    landing = true;
    if (approach > 0) time = std::min(time, active.gap / approach);
  }
  // One that only gravity brings down within the step lands at its end.
  if (landing) time = std::min(time, (1 - kShortPart) * dt);
  return landing && time > kShortPart * dt ? time : dt;
}

// The springs along the ground end where their points are, which a turn moves by more than rate
// times step.
void Plant::follow_points(double dt) {
  for (size_t i = 0; i < active_.size(); ++i) {
    Active& active = active_[i];
    if (active.key >= static_cast<long>(points_.size()) || !(active.impulse[0] > 0)) continue;
    const ContactPoint& point = points_[static_cast<size_t>(active.key)];
    const Vector3d now = data_.base_position +
                         (data_.position[point.body] + data_.rotation[point.body] * point.position);
    active.deflection += active.to_contact.bottomRows<2>() * (now - active.position) -
                         dt * Eigen::Map<const Eigen::Vector2d>(&rates_[3 * i + 1]);
  }
}

// Joints move with their solved rates. The base then takes the velocity that gives the robot, in
// its new posture, exactly the momentum the outside has left it: M(q) v changes along the step, and
// this is what keeps momentum to rounding in flight and ground forces equal to its rate in contact.
void Plant::advance(double dt) {
  const Vector3d cog = data_.cog;
  find_pivot();
  // About a pivot the way is that of the mean rate too: without the half step that the turn by
  // gravity and pushes is ahead of it.
  const Vector3d lag =
      pivot_.freedom > 0 ? Vector3d(0.5 * dt * turn_about_pivot(external_)) : Vector3d::Zero();
  state_.dtheta = velocity_.tail(model_->dof_count());
  state_.theta += dt * state_.dtheta;
  state_.base.attitude =
      (exp_rotation(dt * turned_forward(velocity_.segment<3>(3)) - lag) * state_.base.attitude)
          .normalized();
  update_positions(moving(), state_, data_);
  fill_mass();
  // What the joints alone do, about the base origin, and the inertia with the joints locked.
  Momentum joints;
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double* of_joint = mass_.data() + factor_.row_begin(factor_.place_of(6 + j));
    joints.linear += state_.dtheta[j] * Eigen::Map<const Vector3d>(of_joint);
    joints.angular += state_.dtheta[j] * Eigen::Map<const Vector3d>(of_joint + 3);
  }
  const double mass = moving().mass();
  const Vector3d& c = data_.cog_offset;
  joints.angular -= c.cross(joints.linear);
  const Vector3d cog_velocity = momentum_.linear / mass;
  const Vector3d w = locked_inertia().llt().solve(momentum_.angular - joints.angular);
  state_.base_angular_velocity = w;
  state_.base_velocity = cog_velocity - joints.linear / mass - w.cross(c);
  // Nothing but gravity and pushes: the force is constant and the way that of the mean velocity, so
  // that the COG of a flight is on its parabola. Contacts are solved for the velocity they end in.
  Vector3d way = dt * cog_velocity;
  if (active_.empty()) way -= 0.5 * dt / mass * external_.linear;
  if (pivot_.freedom > 0) way -= lag.cross(cog - pivot_.point);
  state_.base.position = cog + way - c;
  data_.base_position = state_.base.position;
  data_.cog = data_.base_position + c;
  carry_velocities(moving(), state_, data_);
  if (pivot_.freedom > 0) follow_points(dt);
  turned_ = false;
}

}  // namespace ayumi
