// One step of length h from (q, v), all rates at its end (implicit in servo and contact springs):
//   (M + rotor + h(kd + b) + h^2 kp) v+ = (M + rotor) v + h (kp (target - theta) - bias + ext) + J'
//   l q+ = q moved by h v+
// Contact point i with stiffness k, damping time T, gap g and tangential deflection d:
//   u_n = J_n v+ + g/(h + T) + R l_n,   u_t = J_t v+ + d/(h + T) + R l_t,   R = 1/(h k (h + T)),
// which is the implicit spring l/h = -k (g + h v) - k T v solved for the velocity (for g > 0 the
// damping is left out, so that the point just arrives). u and l obey solve_contacts(). A joint
// whose servo would pass its torque limit is given exactly the limit and the step is solved again.
#include "ayumi/sim/plant/plant.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/servo.hpp"
#include "ayumi/sim/step_check.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStickRate = 1e-3;       // joint rate below which dry friction holds [rad/s]
constexpr double kLimitStiffness = 20.0;  // of a joint's end stop, in servo stiffnesses
constexpr double kStopSink = 0.001;       // of a passive slide's under the weight, times that [m]
constexpr double kStopDamping = 0.02;     // of a passive joint's end stop, damping / stiffness [s]

}  // namespace

Plant::Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world)
    : model_(&model), limits_(limits), ground_(world), data_(model), links_(model), factor_(model) {
  check_world(model, world);
  const int n = model.dof_count();
  kp_.resize(n);
  kd_.resize(n);
  rotor_.resize(n);
  viscous_.resize(n);
  coulomb_.resize(n);
  stop_.resize(n);
  stop_damping_.resize(n);
  for (int j = 0; j < n; ++j) {
    const ServoDescription& servo = model.dofs()[j].servo;
    if (servo.kp <= 0 && !model.description().servos.contains(model.dofs()[j].name))
      fail(ErrorCode::bad_model, model.name() + ": joint " + model.dofs()[j].name +
                                     " has no servo (kp); give it one in the sidecar");
    kp_[j] = servo.kp;
    kd_[j] = servo.kd;
    rotor_[j] = servo.rotor_inertia;
    viscous_[j] = servo.viscous;
    coulomb_[j] = servo.coulomb;
    // A joint without a motor has an end stop all the same.
    const double weight = model.mass() * kGravity;
    const double loose = model.dofs()[j].prismatic ? weight / kStopSink : weight;
    stop_[j] = kLimitStiffness * (kp_[j] > 0 ? kp_[j] : loose);
    stop_damping_[j] = kp_[j] > 0 ? kLimitStiffness * kd_[j] : kStopDamping * stop_[j];
  }
  points_ = contact_points(model);
  groups_ = group_points(points_);
  for (const PointGroup& group : groups_)
    widest_ = std::max(widest_, group.center.norm() + group.radius);
  link_friction_ = world.friction;
  link_stiffness_ = body_stiffness(model);
  is_foot_.assign(model.bodies().size(), 0);
  for (const Side side : {Side::left, Side::right})
    if (model.has_soles()) is_foot_[static_cast<size_t>(model.sole(side).body)] = 1;
  const int columns = model.velocity_count();
  chain_bodies_.resize(model.bodies().size());
  chain_lines_.resize(model.bodies().size());
  for (size_t body = 0; body < chain_bodies_.size(); ++body)
    for (int b = static_cast<int>(body); b > 0; b = model.bodies()[b].parent) {
      chain_bodies_[body].push_back(b);
      chain_lines_[body].push_back(factor_.depth(factor_.place_of(6 + model.bodies()[b].dof)));
    }
  still_ = velocity_ = lower_ = placed_ = impulse_ = VectorXd::Zero(columns);
  before_ = outside_ = still_;
  mass_.resize(factor_.row_doubles());
  for (int j = 0; j < n; ++j) {
    const int place = factor_.place_of(6 + j);
    joint_diagonal_.push_back(static_cast<size_t>(factor_.row_begin(place) + factor_.depth(place)));
  }
  fixed_ = dry_ = torque_ = report_.torque = VectorXd::Zero(n);
  saturated_.resize(static_cast<size_t>(n));
  left_law_.resize(static_cast<size_t>(n));
  sliding_.resize(static_cast<size_t>(n));
  report_.saturated.reserve(static_cast<size_t>(n));
  for (int side = 0; side < 2 && model.has_soles(); ++side)
    report_.soles[side].resize(model.sole(static_cast<Side>(side)).polygon.size());
  kp_now_ = kd_now_ = viscous_now_ = coulomb_now_ = target_now_ = VectorXd::Zero(n);
  const size_t usual = std::min<size_t>(points_.size(), 16);  // room for both soles
  solver_.resize(static_cast<int>(usual));
  J_.resize(usual * 4 * static_cast<size_t>(columns));
  Y_.resize(J_.size());
  runs_.reserve(64);
  product_.reserve(3 * usual + 4 + static_cast<size_t>(columns));
  rates_.reserve(3 * points_.size());
  rates_before_.reserve(rates_.capacity());
  compliance_.resize(usual);
  shift_.resize(usual);
  active_.reserve(points_.size() + 64);
  last_active_.reserve(points_.size() + 64);
  outline_.reserve(16);
  inner_.reserve(64);
  set_state(model.rest_state());
}

void Plant::set_state(const RobotState& state) {
  check_state(*model_, state);
  time_ = 0;
  state_ = state;
  update_velocities(moving(), state_, data_);
  momentum_ = centroidal_momentum(moving(), data_);
  fill_mass();
  active_.clear();
  pivot_ = {};
  links_.reset();
}

// What is carried becomes part of the links: the dynamics below know one robot only.
void Plant::load(const std::vector<CarriedMass>& payloads) {
  if (payloads == carried_) return;
  carried_ = payloads;
  loaded_.reset();
  if (!payloads.empty()) loaded_.emplace(with_payloads(*model_, payloads));
  data_ = RobotData(moving());
  update_velocities(moving(), state_, data_);
  momentum_ = centroidal_momentum(moving(), data_);
  fill_mass();
}

void Plant::take_joints(const VectorXd& targets, const StepInput& input) {
  kp_now_ = kp_;
  kd_now_ = kd_;
  viscous_now_ = viscous_;
  coulomb_now_ = coulomb_;
  target_now_ = targets;
  for (size_t j = 0; j < input.joints.size(); ++j) {
    const JointFault& fault = input.joints[j];
    const Eigen::Index i = static_cast<Eigen::Index>(j);
    kp_now_[i] *= fault.gain;
    kd_now_[i] *= fault.gain;
    viscous_now_[i] += fault.viscous;
    coulomb_now_[i] += fault.coulomb;
    target_now_[i] -= fault.encoder;
  }
}

void Plant::push(const ExternalWrench& w, double dt) {
  const int body = w.body < 0 ? model_->trunk_body() : w.body;
  const Vector3d point = w.body < 0 ? data_.cog : w.point;
  const Vector3d p = point - data_.base_position;
  const Vector3d force = dt * w.force, torque = dt * w.torque;
  outside_.head<3>() += force;
  outside_.segment<3>(3) += p.cross(force) + torque;
  for (int i = body; i > 0; i = model_->bodies()[i].parent) {
    const Body& b = model_->bodies()[i];
    outside_[6 + b.dof] +=
        b.ratio * data_.axis[i].dot(b.prismatic
                                        ? force
                                        : Vector3d((p - data_.position[i]).cross(force) + torque));
  }
  external_.linear += force;
  external_.angular += torque + (point - data_.cog).cross(force);
}

// Of the posture in data_.
void Plant::fill_mass() {
  std::fill(mass_.begin(), mass_.end(), 0.0);
  data_.kernels->mass_entries(data_.tree(), data_.bodies(), factor_.layout(), mass_.data());
  for (size_t j = 0; j < joint_diagonal_.size(); ++j)
    mass_[joint_diagonal_[j]] += rotor_[static_cast<Eigen::Index>(j)];
}

// Fills the impulses of bias and pushes and what the contact solve needs.
void Plant::assemble(const StepInput& input, double dt, bool landing) {
  newton_euler(moving(), state_, still_, data_, bias_);
  before_ << state_.base_velocity, state_.base_angular_velocity, state_.dtheta;
  impulse_ = -dt * bias_;
  external_.linear = {0, 0, -dt * moving().mass() * kGravity};
  external_.angular.setZero();
  outside_.setZero();
  for (const ExternalWrench& w : input.wrenches) push(w, dt);
  if (!input.wrenches.empty()) impulse_ += outside_;
  collect_contacts(dt);
  if (landing)
    std::erase_if(active_, [](const Active& a) { return a.gap > 0 && a.impulse.isZero(0); });
  if (pivot_.freedom > 0) turn_half(dt);
  fill_contact_rows(dt);
}

// velocity_ and contact impulses with the joints' laws as they are decided now, by (P1) for the
// change of velocity: D of the joints' laws on the diagonal, M~ (v+ - v) = impulses - D v.
void Plant::solve_velocity(double dt) {
  const int n = model_->dof_count();
  std::vector<double>& system = factor_.rows();
  system = mass_;
  velocity_ = impulse_;
  for (int j = 0; j < n; ++j) {
    const double theta = state_.theta[j];
    double& force = velocity_[6 + j];
    double diagonal = dt * viscous_now_[j];
    if (saturated_[j]) {
      force += dt * fixed_[j];
    } else {
      diagonal += dt * kd_now_[j] + dt * dt * kp_now_[j];
      force += dt * kp_now_[j] * (target_now_[j] - theta);
    }
    if (coulomb_now_[j] > 0) {
      if (sliding_[j])
        force += dt * dry_[j];
      else
        diagonal += dt * coulomb_now_[j] / kStickRate;
    }
    const Dof& dof = model_->dofs()[j];
    if (dof.limited && (theta < dof.lower || theta > dof.upper)) {
      diagonal += dt * dt * stop_[j] + dt * stop_damping_[j];
      force += dt * stop_[j] * (std::clamp(theta, dof.lower, dof.upper) - theta);
    }
    force -= diagonal * before_[6 + j];
    system[joint_diagonal_[static_cast<size_t>(j)]] += diagonal;
  }
  const int columns = model_->velocity_count();
  if (!factor_.factor_rows())
    fail(ErrorCode::internal, model_->name() + ": the mass matrix is not positive " +
                                  text::fixed(time_, 3) + " s after the plant's start");
  for (int k = 0; k < columns; ++k) lower_[k] = velocity_[factor_.column_at(k)];
  factor_.solve_upper(lower_);
  iterations_ = 0;
  residual_ = 0;
  if (!active_.empty()) {
    fill_delassus();
    const ContactSolution solution = solver_.solve();
    iterations_ = solution.iterations;
    residual_ = solution.residual;
    add_impulses(lower_);
  }
  factor_.solve_lower(lower_);
  for (int k = 0; k < columns; ++k) {
    const int c = factor_.column_at(k);
    velocity_[c] = before_[c] + lower_[k];
  }
}

bool Plant::limit_torques(double dt) {
  bool changed = false;
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double rate = velocity_[6 + j];
    if (!saturated_[j]) {
      double& torque = torque_[j];
      torque = kp_now_[j] * (target_now_[j] - state_.theta[j] - dt * rate) - kd_now_[j] * rate;
      const double limit = available_torque(limits_, j, rate, torque > 0 ? 1.0 : -1.0);
      if (std::abs(torque) > limit) {
        saturated_[j] = changed = true;
        fixed_[j] = torque = std::copysign(limit, torque);
      }
    }
    if (coulomb_now_[j] > 0 && !sliding_[j] && std::abs(rate) > kStickRate) {
      sliding_[j] = changed = true;
      dry_[j] = -std::copysign(coulomb_now_[j], rate);
    }
  }
  return changed;
}

const StepReport& Plant::step(const VectorXd& targets, const StepInput& input, double dt) {
  check_step(*model_, targets, input, dt, time_);
  load(input.payloads);
  take_joints(targets, input);
  ground_.set(input);
  clear_report();
  solve(input, dt);
  // Where a robot that pivots lands, the step is taken in two parts: to there, and on from there.
  const double landing = time_of_landing(dt);
  if (landing < dt) {
    active_.swap(last_active_);
    solve(input, landing, true);
    finish(landing, dt);
    solve(input, dt - landing);
    finish(dt - landing, dt);
  } else {
    finish(dt, dt);
  }
  for (int j = 0; j < model_->dof_count(); ++j)
    if (left_law_[j]) report_.saturated.push_back(j);
  return report_;
}

// Velocity and contact impulses of a step or of a part of it; of one that ends in a landing without
// what lands.
void Plant::solve(const StepInput& input, double dt, bool landing) {
  assemble(input, dt, landing);
  const int n = model_->dof_count();
  // A joint that has left its servo's law, or sticking friction, keeps to that within the step.
  std::fill(saturated_.begin(), saturated_.end(), 0);
  std::fill(sliding_.begin(), sliding_.end(), 0);
  for (int pass = 0; pass <= 2 * n; ++pass) {
    solve_velocity(dt);
    if (!limit_torques(dt)) break;
  }
  if (!velocity_.allFinite())
    fail(ErrorCode::internal, model_->name() + ": the plant left the finite numbers " +
                                  text::fixed(time_, 3) + " s after its start");
}

void Plant::clear_report() {
  report_.torque.setZero();
  for (std::vector<SoleForce>& sole : report_.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report_.body_contact = false;
  report_.saturated.clear();
  std::fill(left_law_.begin(), left_law_.end(), 0);
  report_.contact_iterations = 0;
  report_.contact_residual = report_.max_penetration = 0;
  report_.work = Work{};
  report_.self_contact = {-1, -1};
}

// Takes what solve() found: into the report, where it counts for dt of `whole`, and into the state.
void Plant::finish(double dt, double whole) {
  report_.torque += dt / whole * torque_;
  for (size_t j = 0; j < saturated_.size(); ++j) left_law_[j] |= saturated_[j];
  report_.contact_iterations += iterations_;
  report_.contact_residual = std::max(report_.contact_residual, residual_);
  report_contacts(dt, whole);
  account(dt);
  momentum_.linear += external_.linear;
  momentum_.angular += external_.angular;
  advance(dt);
  time_ += dt;
}

// Work of what acts on the joints and from outside, at the mean of the rates before and after:
// impulse times mean rate is exactly the change of kinetic energy that it makes.
void Plant::account(double dt) {
  Work& work = report_.work;
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double rate = velocity_[6 + j], mean = 0.5 * (before_[6 + j] + rate);
    work.servos += dt * torque_[j] * mean;
    double force = -viscous_now_[j] * rate;
    if (coulomb_now_[j] > 0) force += sliding_[j] ? dry_[j] : -coulomb_now_[j] / kStickRate * rate;
    const Dof& dof = model_->dofs()[j];
    const double theta = state_.theta[j];
    if (dof.limited && (theta < dof.lower || theta > dof.upper))
      force += stop_[j] * (std::clamp(theta, dof.lower, dof.upper) - theta - dt * rate) -
               stop_damping_[j] * rate;
    work.joints += dt * force * mean;
  }
  work.outside += 0.5 * outside_.dot(before_ + velocity_);
}

}  // namespace ayumi
