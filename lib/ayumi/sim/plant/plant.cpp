#include "ayumi/sim/plant/plant.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/step_check.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

Plant::Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world)
    : model_(&model),
      joints_(model, limits),
      contacts_(model, world),
      system_(model, limits, contacts_.point_count()),
      integrator_(model) {
  check_world(model, world);
  const auto n = static_cast<size_t>(model.dof_count());
  report_.torque = VectorXd::Zero(model.dof_count());
  report_.saturated.reserve(n);
  limited_.resize(n);
  for (int side = 0; side < 2 && model.has_soles(); ++side)
    report_.soles[side].resize(model.sole(static_cast<Side>(side)).polygon.size());
  set_state(model.rest_state());
}

void Plant::set_state(const RobotState& state) {
  check_state(*model_, state);
  time_ = 0;
  integrator_.set_state(robot(), state, system_);
  contacts_.reset();
  joints_.reset(state);
}

// Loads become part of the links, so that the dynamics only know one robot.
void Plant::load(const std::vector<CarriedMass>& payloads) {
  if (payloads == carried_) return;
  carried_ = payloads;
  loaded_.reset();
  if (!payloads.empty()) loaded_.emplace(with_payloads(*model_, payloads));
  integrator_.set_load(robot(), system_);
}

const StepReport& Plant::step(const VectorXd& targets, const StepInput& input, double dt) {
  check_step(*model_, targets, input, dt, time_);
  load(input.payloads);
  joints_.set(targets, input.joints, state().theta, dt);
  contacts_.ground().set(input);
  clear_report();
  solve(input, dt);
  // If a pivoting robot lands within the step, the step is made in two parts: up to the landing,
  // and from there on.
  const double landing = integrator_.time_of_landing(system_, contacts_, dt);
  if (landing < dt) {
    contacts_.undo_collect();
    solve(input, landing, true);
    finish(landing, dt);
    solve(input, dt - landing);
    finish(dt - landing, dt);
  } else {
    finish(dt, dt);
  }
  for (size_t j = 0; j < limited_.size(); ++j)
    if (limited_[j]) report_.saturated.push_back(static_cast<int>(j));
  return report_;
}

// The velocity and the contact impulses of a step or of a part of it. In a part that ends with a
// landing, the landing points are left out.
void Plant::solve(const StepInput& input, double dt, bool landing) {
  const RobotState& state = integrator_.state();
  RobotData& data = integrator_.data();
  system_.begin(robot(), state, data, dt);
  system_.push(*model_, input.wrenches, data, dt);
  contacts_.collect(data, dt);
  if (landing) contacts_.remove_arriving();
  if (integrator_.pivots()) integrator_.turn_half(robot(), dt, system_, contacts_.active());
  system_.set_contacts(contacts_.active(), data, dt);
  if (!system_.solve(joints_, data, state.theta, dt))
    fail(ErrorCode::internal, model_->name() + ": the mass matrix is not positive definite " +
                                  text::fixed(time_, 3) + " s after the plant's start");
  if (!system_.velocity().allFinite())
    fail(ErrorCode::internal, model_->name() + ": the plant's velocity is not a finite number " +
                                  text::fixed(time_, 3) + " s after its start");
}

void Plant::clear_report() {
  report_.torque.setZero();
  for (std::vector<SoleForce>& sole : report_.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report_.body_contact = false;
  report_.touching_body = -1;
  report_.saturated.clear();
  std::fill(limited_.begin(), limited_.end(), 0);
  report_.contact_iterations = 0;
  report_.contact_residual = report_.max_penetration = 0;
  report_.work = EnergyBalance{};
  report_.self_contact = {-1, -1};
}

// Adds the solution for the time `dt` to the report, whose forces are means over `whole`, and
// advances the state by it. An impulse times the mean of the rates before and after it is exactly
// the change of kinetic energy that it makes.
void Plant::finish(double dt, double whole) {
  report_.torque += dt / whole * joints_.torque();
  for (size_t j = 0; j < limited_.size(); ++j)
    limited_[j] |= static_cast<char>(joints_.saturated(static_cast<int>(j)));
  const ContactSolution& solution = system_.contact_solution();
  report_.contact_iterations += solution.iterations;
  report_.contact_residual = std::max(report_.contact_residual, solution.residual);
  system_.take_impulses(contacts_.active(), data(), dt, report_.work.contacts);
  report_contacts(whole);
  joints_.advance(state().theta, system_.joint_rates_before(), system_.joint_rates(), dt,
                  report_.work);
  report_.work.outside += system_.work_from_outside();
  integrator_.advance(robot(), dt, system_, contacts_);
  joints_.motors(state().theta, state().dtheta, report_.motor, report_.motor_rate);
  time_ += dt;
}

// The forces are the impulses of the contacts divided by `whole` [s].
void Plant::report_contacts(double whole) {
  for (const ActiveContact& contact : contacts_.active()) {
    const bool touching = contact.impulse[0] > 0;
    if (contact.other >= 0) {  // a contact within the robot
      if (touching && report_.self_contact[0] < 0)
        report_.self_contact = {contact.body, contact.other};
      continue;
    }
    const Vector3d impulse = system_.in_world(contact.to_contact.transpose() * contact.impulse);
    system_.external().linear += impulse;
    system_.external().angular += system_.in_world(contact.position - data().cog).cross(impulse);
    if (contact.side >= 0) {
      report_sole(contact, impulse / whole);
    } else if (touching && !report_.body_contact) {
      report_.body_contact = true;
      report_.touching_body = contact.body;
    }
  }
}

void Plant::report_sole(const ActiveContact& contact, const Vector3d& force) {
  report_.max_penetration = std::max(report_.max_penetration, -contact.gap);
  if (contact.vertex < 0) {
    share_among_cells(contact, force);
    return;
  }
  SoleForce& cell = report_.soles[contact.side][static_cast<size_t>(contact.vertex)];
  cell.position = contact.position;
  cell.force += force;
  cell.gap = contact.gap;
}

void Plant::share_among_cells(const ActiveContact& contact, const Vector3d& force) {
  const auto side = static_cast<Side>(contact.side);
  const Sole& sole = model_->sole(side);
  const Eigen::Isometry3d pose = sole_pose(*model_, data(), side);
  corner_weights(sole.polygon, (pose.inverse() * contact.position).head<2>(), weights_);
  for (size_t i = 0; i < weights_.size(); ++i) {
    SoleForce& cell = report_.soles[contact.side][i];
    cell.position = pose * Vector3d(sole.polygon[i].x(), sole.polygon[i].y(), 0);
    cell.force += weights_[i] * force;
  }
}

}  // namespace ayumi
