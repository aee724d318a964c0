// One step of length h from (q, v), all rates at its end (implicit in servo and contact springs):
//   (M + rotor + h(kd + b) + h^2 kp) v+ = (M + rotor) v + h (kp (target - theta) - bias + ext) + J'
//   l q+ = q moved by h v+
// Contact point i with stiffness k, damping time T, gap g and tangential deflection d:
//   u_n = J_n v+ + g/(h + T) + R l_n,   u_t = J_t v+ + d/(h + T) + R l_t,   R = 1/(h k (h + T)),
// which is the implicit spring l/h = -k (g + h v) - k T v solved for the velocity (for g > 0 the
// damping is left out, so that the point just arrives). u and l obey solve_contacts(). A joint
// whose servo would pass its torque limit is given exactly the limit and the step is solved again.
#include "ayumi/sim/plant.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStickRate = 1e-3;       // joint rate below which dry friction holds [rad/s]
constexpr double kLargest = 1e6;          // number that is taken for one [SI]
constexpr double kLimitStiffness = 20.0;  // of a joint's end stop, in servo stiffnesses

/// Largest magnitude; NaN when any entry is.
template <typename Vector>
double largest(const Vector& v) {
  double result = 0;
  for (Eigen::Index i = 0; i < v.size() && !std::isnan(result); ++i)
    if (!(std::abs(v[i]) <= result)) result = std::abs(v[i]);
  return result;
}

}  // namespace

Plant::Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world)
    : model_(&model), limits_(limits), world_(world), data_(model), factor_(model) {
  const int n = model.dof_count();
  kp_.resize(n);
  kd_.resize(n);
  rotor_.resize(n);
  viscous_.resize(n);
  coulomb_.resize(n);
  for (int j = 0; j < n; ++j) {
    const ServoDescription& servo = model.dofs()[j].servo;
    if (servo.kp <= 0)
      fail(ErrorCode::bad_model, model.name() + ": joint " + model.dofs()[j].name +
                                     " has no servo (kp); give it one in the sidecar");
    kp_[j] = servo.kp;
    kd_[j] = servo.kd;
    rotor_[j] = servo.rotor_inertia;
    viscous_[j] = servo.viscous;
    coulomb_[j] = servo.coulomb;
  }
  const Vector3d normal =
      exp_rotation({world.slope.x(), world.slope.y(), 0}).toRotationMatrix().col(2);
  const Vector3d tangent = (Vector3d::UnitX() - normal.x() * normal).normalized();
  ground_ << normal, tangent, normal.cross(tangent);

  points_ = contact_points(model);
  groups_ = group_points(points_);
  const int columns = model.velocity_count();
  still_ = velocity_ = lower_ = VectorXd::Zero(columns);
  fixed_ = dry_ = report_.torque = VectorXd::Zero(n);
  saturated_.resize(static_cast<size_t>(n));
  sliding_.resize(static_cast<size_t>(n));
  report_.saturated.reserve(static_cast<size_t>(n));
  for (int side = 0; side < 2 && model.has_soles(); ++side)
    report_.soles[side].resize(model.sole(static_cast<Side>(side)).polygon.size());
  active_.reserve(points_.size());
  last_active_.reserve(points_.size());
  set_state(model.rest_state());
}

void Plant::set_state(const RobotState& state) {
  const std::string& name = model_->name();
  auto check = [&](const char* what, double largest) {
    if (!(largest < kLargest))
      fail(ErrorCode::usage, name + ": " + what + " of the plant's state is " +
                                 text::brief(largest) + "; numbers below 1e6 are expected");
  };
  if (state.theta.size() != model_->dof_count() || state.dtheta.size() != model_->dof_count())
    fail(ErrorCode::usage,
         name + ": the plant's state needs " + std::to_string(model_->dof_count()) + " joints");
  check("base position", largest(state.base.position));
  check("base attitude", largest(state.base.attitude.coeffs()));
  check("base velocity", largest(state.base_velocity));
  check("base angular velocity", largest(state.base_angular_velocity));
  check("a joint position", largest(state.theta));
  check("a joint rate", largest(state.dtheta));
  time_ = 0;
  state_ = state;
  update_velocities(*model_, state_, data_);
  for (ContactPoint& point : points_) {
    point.impulse.setZero();
    point.deflection.setZero();
    point.touching = false;
  }
}

void Plant::check_input(const VectorXd& targets, const std::vector<ExternalWrench>& wrenches,
                        double dt) const {
  auto complain = [&](const std::string& what) {
    fail(ErrorCode::usage, model_->name() + ": " + what + ", " + text::fixed(time_, 3) +
                               " s after the plant's start");
  };
  if (!(dt > 0 && dt < 1)) complain("step length " + text::brief(dt) + " s is not within 0..1 s");
  if (targets.size() != model_->dof_count())
    complain(std::to_string(targets.size()) + " servo targets for " +
             std::to_string(model_->dof_count()) + " joints");
  for (int j = 0; j < model_->dof_count(); ++j)
    if (!(std::abs(targets[j]) < kLargest))
      complain("servo target of " + model_->dofs()[j].name + " is " + text::brief(targets[j]));
  for (const ExternalWrench& w : wrenches)
    if (!(largest(w.force) < kLargest && largest(w.torque) < kLargest &&
          largest(w.point) < kLargest))
      complain("an external force is not a finite number below 1e6");
}

void Plant::collect_contacts(double dt) {
  for (const Active& active : active_) points_[static_cast<size_t>(active.point)].touching = false;
  size_t kept = 0;
  const Vector3d normal = ground_.col(0);
  // Gravity and servos can change the approach within the step: keep what may arrive in three.
  auto far = [&](double gap, double speed) { return gap + 3 * dt * std::min(speed, 0.0) > 1e-3; };
  last_active_.swap(active_);
  active_.clear();
  for (const PointGroup& group : groups_) {
    const Matrix3d& R = data_.rotation[group.body];
    const Vector3d offset = data_.position[group.body] + R * group.center;
    const double height = normal.dot(data_.base_position + offset) - group.radius;
    const double spread = group.radius * data_.angular_velocity[group.body].norm();
    const Vector3d center = data_.base_position + offset;
    if (far(height, normal.dot(point_velocity(data_, group.body, center)) - spread)) continue;
    for (int i = group.first; i < group.first + group.count; ++i) {
      const ContactPoint& point = points_[static_cast<size_t>(i)];
      const Vector3d position = data_.base_position +
                                (data_.position[group.body] + R * point.position) -
                                point.radius * normal;
      const double gap = normal.dot(position);
      if (far(gap, normal.dot(point_velocity(data_, group.body, position)))) continue;
      active_.push_back({i, gap, position});
    }
  }
  // Points that have left forget their impulse.
  for (const Active& last : last_active_) {
    while (kept < active_.size() && active_[kept].point < last.point) ++kept;
    if (kept < active_.size() && active_[kept].point == last.point) continue;
    ContactPoint& point = points_[static_cast<size_t>(last.point)];
    point.impulse.setZero();
    point.deflection.setZero();
  }
}

void Plant::push(const ExternalWrench& w, double dt) {
  const int body = w.body < 0 ? model_->trunk_body() : w.body;
  const Vector3d point = w.body < 0 ? data_.cog : w.point;
  const Vector3d p = point - data_.base_position;
  const Vector3d force = dt * w.force, torque = dt * w.torque;
  momentum_.head<3>() += force;
  momentum_.segment<3>(3) += p.cross(force) + torque;
  for (int i = body; i > 0; i = model_->bodies()[i].parent) {
    const Body& b = model_->bodies()[i];
    momentum_[6 + b.dof] +=
        b.ratio * data_.axis[i].dot(b.prismatic
                                        ? force
                                        : Vector3d((p - data_.position[i]).cross(force) + torque));
  }
  external_.linear += force;
  external_.angular += torque + (point - data_.cog).cross(force);
}

// Fills M_ (with rotors), the momentum and bias terms and what the contact solve needs.
void Plant::assemble(const std::vector<ExternalWrench>& wrenches, double dt) {
  newton_euler(*model_, state_, still_, data_, bias_);
  mass_matrix(*model_, data_, M_);
  M_.diagonal().tail(model_->dof_count()) += rotor_;
  velocity_ << state_.base_velocity, state_.base_angular_velocity, state_.dtheta;
  momentum_.noalias() = M_ * velocity_;
  momentum_ -= dt * bias_;
  external_.linear = {0, 0, -dt * model_->mass() * kGravity};
  external_.angular.setZero();
  for (const ExternalWrench& w : wrenches) push(w, dt);
  collect_contacts(dt);
  fill_contact_rows(dt);
}

void Plant::fill_contact_rows(double dt) {
  const size_t n = active_.size(), columns = static_cast<size_t>(model_->velocity_count());
  solver_.resize(static_cast<int>(n));
  if (J_.size() < n * columns) {
    J_.resize(n * columns);
    Y_.resize(n * columns);
  }
  compliance_.resize(n);
  shift_.resize(n);
  const Matrix3d to_ground = ground_.transpose();
  for (size_t i = 0; i < n; ++i) {
    const ContactPoint& point = points_[static_cast<size_t>(active_[i].point)];
    const double time = dt + point.damping_time, gap = active_[i].gap;
    compliance_[i] = 1.0 / (dt * point.stiffness * time);
    shift_[i] << (gap > 0 ? gap / dt : gap / time), point.deflection / time;
    solver_.impulse().segment<3>(3 * static_cast<int>(i)) = point.impulse;
    solver_.friction()[i] = world_.friction;

    Vector3d* row = &J_[i * columns];
    for (int k = factor_.last_place(point.body); k >= 0; k = factor_.parent(k)) row[k].setZero();
    const Vector3d p = active_[i].position - data_.base_position;
    for (int k = 0; k < 3; ++k) {
      row[k] = to_ground.col(k);
      row[3 + k] = to_ground * Vector3d::Unit(k).cross(p);
    }
    for (int b = point.body; b > 0; b = model_->bodies()[b].parent) {
      const Body& body = model_->bodies()[b];
      const Vector3d a = body.ratio * data_.axis[b];
      row[factor_.place_of(6 + body.dof)] +=
          to_ground * (body.prismatic ? a : Vector3d(a.cross(p - data_.position[b])));
    }
  }
}

// A = Y' Y + compliance with Y = L^-T J'; b = Y' lower_ + shift, lower_ = L^-T right side.
void Plant::fill_delassus() {
  const size_t n = active_.size(), columns = static_cast<size_t>(model_->velocity_count());
  auto A = solver_.A();
  auto b = solver_.b();
  for (size_t i = 0; i < n; ++i) {
    const int last = factor_.last_place(points_[static_cast<size_t>(active_[i].point)].body);
    const Vector3d* row = &J_[i * columns];
    Vector3d* Yi = &Y_[i * columns];
    for (int k = last; k >= 0; k = factor_.parent(k)) Yi[k] = row[k];
    factor_.solve_chain(last, Yi);
    Vector3d free = shift_[i];
    for (int k = last; k >= 0; k = factor_.parent(k)) free += lower_[k] * Yi[k];
    b.segment<3>(3 * static_cast<int>(i)) = free;
    for (size_t j = 0; j <= i; ++j) {
      const Vector3d* Yj = &Y_[j * columns];
      int ki = last;
      int kj = factor_.last_place(points_[static_cast<size_t>(active_[j].point)].body);
      while (ki != kj) (ki > kj ? ki : kj) = factor_.parent(ki > kj ? ki : kj);
      Matrix3d block = Matrix3d::Zero();
      for (int k = ki; k >= 0; k = factor_.parent(k)) block += Yi[k] * Yj[k].transpose();
      const int r = 3 * static_cast<int>(i), c = 3 * static_cast<int>(j);
      A.block<3, 3>(r, c) = block;
      A.block<3, 3>(c, r) = block.transpose();
    }
    A.block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(i)).diagonal().array() +=
        compliance_[i];
  }
}

// velocity_ and contact impulses with the joints' laws as they are decided now.
void Plant::solve_velocity(const VectorXd& targets, double dt) {
  const int n = model_->dof_count();
  system_ = M_;
  velocity_ = momentum_;
  for (int j = 0; j < n; ++j) {
    const double theta = state_.theta[j];
    double& diagonal = system_(6 + j, 6 + j);
    double& force = velocity_[6 + j];
    diagonal += dt * viscous_[j];
    if (saturated_[j]) {
      force += dt * fixed_[j];
    } else {
      diagonal += dt * kd_[j] + dt * dt * kp_[j];
      force += dt * kp_[j] * (targets[j] - theta);
    }
    if (coulomb_[j] > 0) {
      if (sliding_[j])
        force += dt * dry_[j];
      else
        diagonal += dt * coulomb_[j] / kStickRate;
    }
    const Dof& dof = model_->dofs()[j];
    if (dof.limited && (theta < dof.lower || theta > dof.upper)) {
      const double stop = kLimitStiffness * kp_[j];
      diagonal += dt * dt * stop + dt * kLimitStiffness * kd_[j];
      force += dt * stop * (std::clamp(theta, dof.lower, dof.upper) - theta);
    }
  }
  const int columns = model_->velocity_count();
  if (!factor_.factor(system_))
    fail(ErrorCode::internal, model_->name() + ": the mass matrix is not positive " +
                                  text::fixed(time_, 3) + " s after the plant's start");
  for (int k = 0; k < columns; ++k) lower_[k] = velocity_[factor_.column_at(k)];
  factor_.solve_upper(lower_);
  if (!active_.empty()) {
    fill_delassus();
    const ContactSolution solution = solver_.solve();
    report_.contact_iterations = solution.iterations;
    report_.contact_residual = solution.residual;
    for (size_t i = 0; i < active_.size(); ++i) {
      const Vector3d l = solver_.impulse().segment<3>(3 * static_cast<int>(i));
      const Vector3d* Y = &Y_[i * static_cast<size_t>(columns)];
      const int last = factor_.last_place(points_[static_cast<size_t>(active_[i].point)].body);
      for (int k = last; k >= 0; k = factor_.parent(k)) lower_[k] += Y[k].dot(l);
    }
  }
  factor_.solve_lower(lower_);
  for (int k = 0; k < columns; ++k) velocity_[factor_.column_at(k)] = lower_[k];
}

// Torques at the solved velocity; true when a joint has left its law, so that the step must be
// solved again.
bool Plant::limit_torques(const VectorXd& targets, double dt) {
  bool changed = false;
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double rate = velocity_[6 + j];
    if (!saturated_[j]) {
      double& torque = report_.torque[j];
      torque = kp_[j] * (targets[j] - state_.theta[j] - dt * rate) - kd_[j] * rate;
      const double limit = available_torque(limits_, j, rate, torque > 0 ? 1.0 : -1.0);
      if (std::abs(torque) > limit) {
        saturated_[j] = changed = true;
        fixed_[j] = torque = std::copysign(limit, torque);
      }
    }
    if (coulomb_[j] > 0 && !sliding_[j] && std::abs(rate) > kStickRate) {
      sliding_[j] = changed = true;
      dry_[j] = -std::copysign(coulomb_[j], rate);
    }
  }
  return changed;
}

void Plant::report_contacts(double dt) {
  const size_t columns = static_cast<size_t>(model_->velocity_count());
  for (std::vector<SoleForce>& sole : report_.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report_.body_contact = false;
  report_.max_penetration = 0;
  for (size_t i = 0; i < active_.size(); ++i) {
    ContactPoint& point = points_[static_cast<size_t>(active_[i].point)];
    const Vector3d l = solver_.impulse().segment<3>(3 * static_cast<int>(i));
    const Vector3d force = ground_ * l;
    external_.linear += force;
    external_.angular += (active_[i].position - data_.cog).cross(force);
    Vector3d motion = Vector3d::Zero();
    for (int k = factor_.last_place(point.body); k >= 0; k = factor_.parent(k))
      motion += velocity_[factor_.column_at(k)] * J_[i * columns + static_cast<size_t>(k)];
    point.impulse = l;
    point.touching = l[0] > 0;
    point.deflection.setZero();
    if (point.touching)
      point.deflection =
          -l.tail<2>() / (dt * point.stiffness) - point.damping_time * motion.tail<2>();
    if (point.side >= 0) {
      SoleForce& cell = report_.soles[point.side][static_cast<size_t>(point.vertex)];
      cell.position = active_[i].position;
      cell.force = force / dt;
      cell.gap = active_[i].gap;
      report_.max_penetration = std::max(report_.max_penetration, -active_[i].gap);
    } else if (point.touching) {
      report_.body_contact = true;
    }
  }
}

const StepReport& Plant::step(const VectorXd& targets, const std::vector<ExternalWrench>& wrenches,
                              double dt) {
  check_input(targets, wrenches, dt);
  assemble(wrenches, dt);
  Momentum momentum = centroidal_momentum(*model_, data_);
  const int n = model_->dof_count();
  // A joint that has left its servo's law, or sticking friction, keeps to that within the step.
  std::fill(saturated_.begin(), saturated_.end(), 0);
  std::fill(sliding_.begin(), sliding_.end(), 0);
  report_.contact_iterations = 0;
  report_.contact_residual = 0;
  for (int pass = 0; pass <= 2 * n; ++pass) {
    solve_velocity(targets, dt);
    if (!limit_torques(targets, dt)) break;
  }
  if (!velocity_.allFinite())
    fail(ErrorCode::internal, model_->name() + ": the plant left the finite numbers " +
                                  text::fixed(time_, 3) + " s after its start");
  report_.saturated.clear();
  for (int j = 0; j < n; ++j)
    if (saturated_[j]) report_.saturated.push_back(j);
  report_contacts(dt);
  momentum.linear += external_.linear;
  momentum.angular += external_.angular;
  advance(momentum, dt);
  time_ += dt;
  return report_;
}

// Joints move with their solved rates. The base then takes the velocity that gives the robot, in
// its new posture, exactly the momentum the outside has left it: M(q) v changes along the step, and
// this is what keeps momentum to rounding in flight and ground forces equal to its rate in contact.
void Plant::advance(const Momentum& momentum, double dt) {
  const Vector3d cog = data_.cog;
  state_.dtheta = velocity_.tail(model_->dof_count());
  state_.theta += dt * state_.dtheta;
  state_.base.attitude =
      (exp_rotation(dt * velocity_.segment<3>(3)) * state_.base.attitude).normalized();
  state_.base_velocity.setZero();
  state_.base_angular_velocity.setZero();
  update_velocities(*model_, state_, data_);
  const Momentum joints = centroidal_momentum(*model_, data_);
  const Vector3d cog_velocity = momentum.linear / model_->mass();
  const Vector3d w = locked_inertia(*model_, data_).llt().solve(momentum.angular - joints.angular);
  state_.base_angular_velocity = w;
  state_.base_velocity = cog_velocity - joints.linear / model_->mass() - w.cross(data_.cog_offset);
  state_.base.position = cog + dt * cog_velocity - data_.cog_offset;
  data_.base_position = state_.base.position;
  data_.cog = data_.base_position + data_.cog_offset;
  add_base_velocity(state_.base_velocity, w, data_);
}

}  // namespace ayumi
