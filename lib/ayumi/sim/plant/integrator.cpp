// Joints move with their solved rates. The base then gets the velocity with which the robot, in its
// new posture, has exactly the momentum that results from gravity and the forces from outside: M(q)
// v changes along the step, and with this correction, the momentum in flight is exact up to
// rounding, and the ground forces in contact equal the rate of momentum.
//
// No spring holds a robot that turns about an edge or a corner, and a step of first order would
// lose energy there. Its step is therefore computed for the posture half a step ahead. Up to this
// posture, the robot turns as one body. So its numbers do not change in axes that turn with it, and
// only gravity and the ground are turned back in these axes.
#include "ayumi/sim/plant/integrator.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Contacts that are closer to each other than this count as one point of the pivot [m]. Chosen:
/// far below the distance of two corners of a sole and far above the rounding of positions. No
/// measured case changes between half and twice the value (constants.md).
constexpr double kOnePoint = 1e-6;

/// Contacts lie on a line if their distance from it is less than this fraction of its length.
/// Chosen: 0.01 mm for an edge of 0.1 m; if a contact is farther from the line, the robot cannot
/// turn about it. Between half and twice the value, figures change by less than 5 %.
constexpr double kStraight = 1e-4;

/// A part of a step that is shorter than this fraction of the step is not integrated separately.
/// Chosen: in 0.02 ms of 1 ms, a point that falls at 1 m/s moves by 0.02 mm, which does not justify
/// a separate solve. Between half and twice the value, figures change by less than 5 %.
constexpr double kShortestPart = 0.02;

}  // namespace

void Integrator::set_state(const RobotModel& robot, const RobotState& state, StepSystem& system) {
  state_ = state;
  update_velocities(robot, state_, data_);
  momentum_ = centroidal_momentum(robot, data_);
  system.set_posture(data_);
  pivot_ = {};
}

void Integrator::set_load(const RobotModel& robot, StepSystem& system) {
  data_ = RobotData(robot);
  update_velocities(robot, state_, data_);
  momentum_ = centroidal_momentum(robot, data_);
  system.set_posture(data_);
}

// Finds the pivot: one point or one line of the robot's points that press on the ground.
void Integrator::find_pivot(const ContactSet& contacts) {
  pivot_.freedom = 0;
  const Vector3d* first = nullptr;
  double farthest = 0;
  for (const ActiveContact& contact : contacts.active()) {
    if (contact.other >= 0 || !(contact.impulse[0] > 0)) continue;
    if (!contacts.is_pivot(contact)) return;
    if (!first) {
      first = &contact.position;
      continue;
    }
    const Vector3d along = contact.position - *first;
    if (along.squaredNorm() <= farthest) continue;
    farthest = along.squaredNorm();
    pivot_.axis = along;
  }
  if (!first) return;
  pivot_.point = *first;
  pivot_.freedom = 3;
  if (farthest <= kOnePoint * kOnePoint) return;
  pivot_.freedom = 0;
  for (const ActiveContact& contact : contacts.active()) {
    if (contact.other >= 0 || !(contact.impulse[0] > 0)) continue;
    const double off = pivot_.axis.cross(contact.position - pivot_.point).squaredNorm();
    if (off > kStraight * kStraight * farthest * farthest) return;
  }
  pivot_.axis.normalize();
  pivot_.freedom = 1;
}

// The angular velocity about the pivot that the robot, with its joints locked, has with this
// momentum. Forces in the pivot have no moment about it.
Vector3d Integrator::turn_about_pivot(const RobotModel& robot, const StepSystem& system,
                                      const Momentum& given) const {
  const Vector3d r = data_.cog - pivot_.point;
  const Vector3d moment = given.angular + r.cross(given.linear);
  const Matrix3d inertia = parallel_axis(system.locked_inertia(robot, data_), robot.mass(), r);
  if (pivot_.freedom == 3) return inertia.llt().solve(moment);
  const Vector3d& e = pivot_.axis;
  return e.dot(moment) / e.dot(inertia * e) * e;
}

void Integrator::turn_half(const RobotModel& robot, double dt, StepSystem& system,
                           std::vector<ActiveContact>& contacts) const {
  system.turn(
      exp_rotation(0.5 * dt * turn_about_pivot(robot, system, momentum_)).toRotationMatrix(), robot,
      data_, contacts, dt);
}

double Integrator::time_of_landing(const StepSystem& system, const ContactSet& contacts,
                                   double dt) const {
  if (pivot_.freedom == 0 || !contacts.ground().at_rest()) return dt;
  double time = dt;
  bool landing = false;
  for (size_t i = 0; i < contacts.active().size(); ++i) {
    const ActiveContact& contact = contacts.active()[i];
    if (contact.other >= 0 || contact.gap <= 0 || contact.impulse[0] > 0) continue;
    if (!(system.rows().impulse(i)[0] > 0)) continue;
    const double approach =
        contact.to_contact.row(0).dot(contact.ground_velocity) - system.rows().rate_before(i)[0];
    landing = true;
    if (approach > 0) time = std::min(time, contact.gap / approach);
  }
  // A point that only gravity brings down within the step lands at the end of the step.
  if (landing) time = std::min(time, (1 - kShortestPart) * dt);
  return landing && time > kShortestPart * dt ? time : dt;
}

// The tangential springs end where their points are. In a turn, the points move by more than rate
// times step.
void Integrator::follow_points(double dt, const StepSystem& system, ContactSet& contacts) const {
  for (size_t i = 0; i < contacts.active().size(); ++i) {
    ActiveContact& contact = contacts.active()[i];
    const ContactPoint* point = contacts.point_of(contact);
    if (!point || !(contact.impulse[0] > 0)) continue;
    const Vector3d now = data_.base_position + (data_.position[point->body] +
                                                data_.rotation[point->body] * point->position);
    contact.deflection += contact.to_contact.bottomRows<2>() * (now - contact.position) -
                          dt * Vector2d(system.rows().rate(i).tail<2>());
  }
}

void Integrator::advance(const RobotModel& robot, double dt, StepSystem& system,
                         ContactSet& contacts) {
  momentum_.linear += system.external().linear;
  momentum_.angular += system.external().angular;
  const Vector3d cog = data_.cog;
  const Eigen::VectorXd& velocity = system.velocity();
  find_pivot(contacts);
  // The displacement about a pivot is also that of the mean rate, so half of the rate that gravity
  // and pushes add within the step is left out.
  const Vector3d lag = pivot_.freedom > 0
                           ? Vector3d(0.5 * dt * turn_about_pivot(robot, system, system.external()))
                           : Vector3d::Zero();
  const Eigen::Index n = state_.theta.size();
  state_.dtheta = velocity.tail(n);
  state_.theta += dt * state_.dtheta;
  state_.base.attitude =
      (exp_rotation(dt * system.in_world(velocity.segment<3>(3)) - lag) * state_.base.attitude)
          .normalized();
  update_positions(robot, state_, data_);
  system.set_posture(data_);
  // First the momentum of the joints alone about the base origin, then about the COG.
  Momentum joints;
  for (int j = 0; j < n; ++j) {
    const double* unit = system.momentum_of_joint(j);
    joints.linear += state_.dtheta[j] * Eigen::Map<const Vector3d>(unit);
    joints.angular += state_.dtheta[j] * Eigen::Map<const Vector3d>(unit + 3);
  }
  const double mass = robot.mass();
  const Vector3d& c = data_.cog_offset;
  joints.angular -= c.cross(joints.linear);
  const Vector3d cog_velocity = momentum_.linear / mass;
  const Vector3d w =
      system.locked_inertia(robot, data_).llt().solve(momentum_.angular - joints.angular);
  state_.base_angular_velocity = w;
  state_.base_velocity = cog_velocity - joints.linear / mass - w.cross(c);
  // With only gravity and pushes, the force is constant and the displacement is that of the mean
  // velocity, so that the COG of a flight stays on its parabola. Contacts are solved for the
  // velocity at the end of the step.
  Vector3d displacement = dt * cog_velocity;
  if (contacts.active().empty()) displacement -= 0.5 * dt / mass * system.external().linear;
  if (pivot_.freedom > 0) displacement -= lag.cross(cog - pivot_.point);
  state_.base.position = cog + displacement - c;
  data_.base_position = state_.base.position;
  data_.cog = data_.base_position + c;
  carry_velocities(robot, state_, data_);
  if (pivot_.freedom > 0) follow_points(dt, system, contacts);
  system.end_turn();
}

}  // namespace ayumi
