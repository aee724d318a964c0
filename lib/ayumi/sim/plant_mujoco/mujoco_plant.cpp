// The torque of a servo is clamp(kp (target - theta)) - kd dtheta, with the damping as implicit
// joint damping. The angular velocity of MuJoCo's free joint is in body axes.
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/plant_interface.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_impl.hpp"
#include "ayumi/sim/servo.hpp"
#include "ayumi/sim/step_check.hpp"

namespace ayumi {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// The input after the first `t` [s] of the step have passed.
StepInput later(StepInput input, double t) {
  if (input.floor) {
    FloorPose& floor = *input.floor;
    floor.pose.translation() += t * floor.velocity;
    floor.pose.linear() =
        exp_rotation(t * floor.angular_velocity).toRotationMatrix() * floor.pose.linear();
  }
  for (RisingDisc& bump : input.bumps) bump.block.height += t * bump.rate;
  return input;
}

}  // namespace

void MujocoPlant::Impl::build(bool with_bumps) {
  bumps = with_bumps;
  m = mujoco_model(*model, points, limits, world, bumps);
  MujocoData next(mj_makeData(m.get()), mj_deleteData);
  if (d) {  // the motion continues
    mju_copy(next->qpos, d->qpos, m->nq);
    mju_copy(next->qvel, d->qvel, m->nv);
    mju_copy(next->qacc_warmstart, d->qacc_warmstart, m->nv);
    next->time = d->time;
  }
  d = std::move(next);
  find_indices();
  set_inertias();
  mj_forward(m.get(), d.get());
}

void MujocoPlant::Impl::set_inertias() {
  const std::vector<Body>& bodies = moving().bodies();
  for (size_t i = 0; i < bodies.size(); ++i) {
    set_inertia(bodies[i].inertia, body[i], m.get());
    m->body_sameframe[body[i]] = 0;
    m->body_simple[body[i]] = 0;
    if (bodies[i].parent < 0) continue;
    Eigen::Map<Vector3d>(m->body_pos + 3 * body[i]) = bodies[i].placement.translation();
    set_quaternion(m->body_quat + 4 * body[i], Quaterniond(bodies[i].placement.linear()));
  }
  for (int i = 0; i < m->nv; ++i) m->dof_simplenum[i] = 0;
  const MujocoData scratch(mj_makeData(m.get()), mj_deleteData);
  mj_setConst(m.get(), scratch.get());
}

void MujocoPlant::Impl::find_indices() {
  body.clear();
  velocity.clear();
  for (size_t i = 0; i < model->bodies().size(); ++i)
    body.push_back(mujoco_id(m.get(), mjOBJ_BODY, "body" + std::to_string(i)));
  for (int j = 0; j < model->dof_count(); ++j)
    velocity.push_back(m->jnt_dofadr[mujoco_id(m.get(), mjOBJ_JOINT, "joint" + std::to_string(j))]);
  gear.clear();
  for (int j = 0; j < model->dof_count(); ++j) {
    const int id = mujoco_id(m.get(), mjOBJ_JOINT, "gear" + std::to_string(j));
    gear.push_back(id < 0 ? -1 : m->jnt_dofadr[id]);
  }
  floor_id = mujoco_id(m.get(), mjOBJ_BODY, "floor");
  point_of.assign(static_cast<size_t>(m->ngeom), -1);
  for (size_t i = 0; i < points.size(); ++i) {
    const int geom = mujoco_id(m.get(), mjOBJ_GEOM, "point" + std::to_string(i));
    point_of[static_cast<size_t>(geom)] = static_cast<int>(i);
    if (points[i].side >= 0)
      report.soles[points[i].side].resize(static_cast<size_t>(points[i].vertex) + 1);
  }
  for (int side = 0; side < 2; ++side) {
    plate[side] = mujoco_id(m.get(), mjOBJ_GEOM, "plate" + std::to_string(side));
    if (plate[side] >= 0) point_of[static_cast<size_t>(plate[side])] = -2 - side;
  }
}

void MujocoPlant::Impl::read_state() {
  state.base.position = Eigen::Map<const Vector3d>(d->qpos);
  state.base.attitude = Quaterniond(d->qpos[3], d->qpos[4], d->qpos[5], d->qpos[6]).normalized();
  state.base_velocity = Eigen::Map<const Vector3d>(d->qvel);
  state.base_angular_velocity = state.base.attitude * Eigen::Map<const Vector3d>(d->qvel + 3);
  for (int j = 0; j < model->dof_count(); ++j) {
    const int column = velocity[static_cast<size_t>(j)];
    // Positions have one more number: the quaternion has four.
    state.theta[j] = d->qpos[column + 1];
    state.dtheta[j] = d->qvel[column];
    const int play = gear[static_cast<size_t>(j)];
    if (play < 0) continue;
    state.theta[j] += d->qpos[play + 1];
    state.dtheta[j] += d->qvel[play];
  }
  update_velocities(moving(), state, data);
}

void MujocoPlant::Impl::apply(const ExternalWrench& w) {
  const int id = body[static_cast<size_t>(w.body < 0 ? model->trunk_body() : w.body)];
  const Vector3d point = w.body < 0 ? data.cog : w.point;
  const Vector3d at = Eigen::Map<const Vector3d>(d->xipos + 3 * id);
  Eigen::Map<Vector3d>(d->xfrc_applied + 6 * id) += w.force;
  Eigen::Map<Vector3d>(d->xfrc_applied + 6 * id + 3) += w.torque + (point - at).cross(w.force);
}

// As in Plant, a motor cannot push a joint beyond its speed limit, or with more torque than its
// voltage allows.
void MujocoPlant::Impl::limit_torques() {
  for (int j = 0; j < model->dof_count(); ++j) {
    if (!m->actuator_forcelimited[j]) continue;
    const double rate = d->qvel[velocity[static_cast<size_t>(j)]];
    const TorqueRange range = torque_range(limits, j, rate);
    m->actuator_forcerange[2 * j] = range.low;
    m->actuator_forcerange[2 * j + 1] = range.high;
  }
}

// Adds the work at the mean rates of the step. MuJoCo does not distinguish contacts, end stops and
// dry friction.
void MujocoPlant::Impl::account(double dt) {
  const auto of = [&](const mjtNum* v) { return Eigen::Map<const VectorXd>(v, m->nv); };
  mean = 0.5 * (before + of(d->qvel));
  report.work.servos += dt * of(d->qfrc_actuator).dot(mean);
  report.work.joints += dt * of(d->qfrc_passive).dot(mean);
  report.work.contacts += dt * of(d->qfrc_constraint).dot(mean);
  before.setZero();
  for (const int id : body)
    mj_applyFT(m.get(), d.get(), d->xfrc_applied + 6 * id, d->xfrc_applied + 6 * id + 3,
               d->xipos + 3 * id, id, before.data());
  report.work.outside += dt * before.dot(mean);
}

// Forces are summed over MuJoCo's steps, and then divided by their number.
void MujocoPlant::Impl::begin_report() {
  report.torque.setZero();
  report.work = EnergyBalance{};
  report.contact_iterations = 0;
  report.max_penetration = 0;
  report.body_contact = false;
  report.touching_body = -1;
  for (std::vector<SoleForce>& sole : report.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
}

void MujocoPlant::Impl::finish_report() {
  report.torque /= steps;
  for (std::vector<SoleForce>& sole : report.soles)
    for (SoleForce& cell : sole) cell.force /= steps;
}

void MujocoPlant::Impl::report_servos() {
  report.saturated.clear();
  for (int j = 0; j < model->dof_count(); ++j) {
    const double drive = d->actuator_force[j];
    report.torque[j] += drive;
    if (m->actuator_forcelimited[j] &&
        (drive <= m->actuator_forcerange[2 * j] || drive >= m->actuator_forcerange[2 * j + 1]))
      report.saturated.push_back(j);
  }
}

void MujocoPlant::Impl::check_input(const VectorXd& targets, const StepInput& input,
                                    double dt) const {
  check_step(*model, targets, input, dt, d->time);
  if (input.bumps.size() > kMujocoBumps)
    fail(ErrorCode::bad_pattern, "the MuJoCo plant has room for " + std::to_string(kMujocoBumps) +
                                     " bumps at once, not " + std::to_string(input.bumps.size()) +
                                     ". Use --plant ayumi");
}

// Sets the ground, loads, joints and pushes of this step.
void MujocoPlant::Impl::take_input(const VectorXd& targets, const StepInput& input) {
  ground.set(input);
  load(input.payloads);
  take_joints(targets, input);
  for (const ExternalWrench& w : input.wrenches) apply(w);
}

void MujocoPlant::Impl::load(const std::vector<CarriedMass>& payloads) {
  if (payloads == carried) return;
  carried = payloads;
  loaded.reset();
  if (!payloads.empty()) loaded.emplace(with_payloads(*model, payloads));
  set_inertias();
  data = RobotData(moving());
  update_velocities(moving(), state, data);
}

void MujocoPlant::Impl::take_joints(const VectorXd& targets, const StepInput& input) {
  for (int j = 0; j < model->dof_count(); ++j)
    take_servo(j, targets[j],
               input.joints.empty() ? JointFault{} : input.joints[static_cast<size_t>(j)]);
}

// Evaluates the law in this step of MuJoCo. Quantities that depend on the state are taken at the
// start of the step.
void MujocoPlant::Impl::take_servo(int j, double target, const JointFault& fault) {
  const ServoDescription& servo = limits.servo[static_cast<size_t>(j)];
  const int column = velocity[static_cast<size_t>(j)];
  const double phi = d->qpos[column + 1], dphi = d->qvel[column];
  const double kp = fault.gain * servo.kp, kd = fault.gain * servo.kd;
  const ServoError error =
      servo_error(servo, model->dofs()[static_cast<size_t>(j)], target - fault.encoder, phi);
  const double wanted = kp * (error.target - phi), most = kd * servo.speed_command_limit;
  const bool bound = most > 0 && std::abs(wanted) > most;
  m->actuator_gainprm[mjNGAIN * j] = error.inside ? 0 : kp;
  m->actuator_biasprm[mjNBIAS * j + 1] = error.inside || bound ? 0 : -kp;
  m->actuator_biasprm[mjNBIAS * j + 2] = -kd;
  d->ctrl[j] = bound ? std::copysign(most, wanted) / kp : error.target;
  m->dof_frictionloss[column] =
      dry_friction(servo, dphi, motor_torque[j], external[j]) + fault.coulomb;
  m->dof_damping[column] = servo.viscous + fault.viscous;
}

// The torques on the rotors in the step of `h` [s] that has just ended: those of the motors, and
// all others except friction.
void MujocoPlant::Impl::find_loads(double h) {
  for (int j = 0; j < model->dof_count(); ++j) {
    const int column = velocity[static_cast<size_t>(j)];
    motor_torque[j] = d->actuator_force[j];
    external[j] = m->dof_armature[column] * (d->qvel[column] - before[column]) / h -
                  motor_torque[j] - d->qfrc_passive[column];
  }
  for (int i = 0; i < d->nefc; ++i) {
    if (d->efc_type[i] != mjCNSTR_FRICTION_DOF) continue;
    for (int j = 0; j < model->dof_count(); ++j)
      if (velocity[static_cast<size_t>(j)] == d->efc_id[i]) external[j] -= d->efc_force[i];
  }
}

void MujocoPlant::Impl::report_motors() {
  report.motor = state.theta;
  report.motor_rate = state.dtheta;
  for (int j = 0; j < model->dof_count(); ++j) {
    if (gear[static_cast<size_t>(j)] < 0) continue;
    const int column = velocity[static_cast<size_t>(j)];
    report.motor[j] = d->qpos[column + 1];
    report.motor_rate[j] = d->qvel[column];
  }
}

void MujocoPlant::Impl::take_bumps(const std::vector<RisingDisc>& now) {
  if (!now.empty() && !bumps) build(true);
  if (!bumps) return;
  rates.assign(static_cast<size_t>(m->ngeom), 0.0);
  for (int i = 0; i < kMujocoBumps; ++i) {
    const bool there = i < static_cast<int>(now.size());
    const RisingDisc* bump = there ? &now[static_cast<size_t>(i)] : nullptr;
    set_bump(bump, i, m.get());
    for (int part = 0; there && part < 9; ++part)
      rates[static_cast<size_t>(bump_geom(m.get(), i, part))] = bump->rate;
  }
}

MujocoPlant::MujocoPlant(const RobotModel& model, const ActuatorLimits& limits, const World& world,
                         int steps) {
  if (static_cast<int>(model.bodies().size()) != model.dof_count() + 1)
    fail(ErrorCode::bad_model, model.name() + ": the MuJoCo plant does not support mimic joints");
  for (const Dof& dof : model.dofs())
    if (const auto j = static_cast<size_t>(&dof - model.dofs().data());
        limits.servo[j].kp <= 0 && !limits.has_servo[j])
      fail(ErrorCode::bad_model, model.name() + ": joint " + dof.name +
                                     " has no servo. State kp of this joint in the sidecar");
  for (int j = 0; j < model.dof_count(); ++j)
    if (const ServoDescription& servo = limits.servo[static_cast<size_t>(j)];
        mujoco_has_gear(servo) && servo.rotor_inertia <= 0)
      fail(ErrorCode::bad_model, model.name() + ": joint " +
                                     model.dofs()[static_cast<size_t>(j)].name +
                                     ": in the MuJoCo plant a motor behind a gear with backlash or "
                                     "stiffness needs a rotor_inertia above 0");
  check_world(model, world);
  impl_ = std::make_unique<Impl>(model, limits, world, steps);
  impl_->report.torque = VectorXd::Zero(model.dof_count());
  set_state(model.rest_state());
}

MujocoPlant::~MujocoPlant() = default;
MujocoPlant::MujocoPlant(const MujocoPlant& other) : impl_(new Impl(*other.impl_)) {}
MujocoPlant& MujocoPlant::operator=(const MujocoPlant& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
MujocoPlant::MujocoPlant(MujocoPlant&&) noexcept = default;
MujocoPlant& MujocoPlant::operator=(MujocoPlant&&) noexcept = default;

const RobotState& MujocoPlant::state() const { return impl_->state; }
const RobotData& MujocoPlant::data() const { return impl_->data; }

void MujocoPlant::set_state(const RobotState& s) {
  check_state(*impl_->model, s);
  mjData* d = impl_->d.get();
  mj_resetData(impl_->m.get(), d);
  impl_->place_floor();
  impl_->floor = FloorPose{};
  impl_->delay.reset();
  impl_->motor_torque.setZero();
  impl_->external.setZero();
  impl_->state = s;
  Eigen::Map<Vector3d>(d->qpos) = s.base.position;
  set_quaternion(d->qpos + 3, s.base.attitude);
  Eigen::Map<Vector3d>(d->qvel) = s.base_velocity;
  Eigen::Map<Vector3d>(d->qvel + 3) = s.base.attitude.conjugate() * s.base_angular_velocity;
  for (int j = 0; j < impl_->model->dof_count(); ++j) {
    const int column = impl_->velocity[static_cast<size_t>(j)];
    d->qpos[column + 1] = s.theta[j];
    d->qvel[column] = s.dtheta[j];
  }
  mj_forward(impl_->m.get(), d);
  update_velocities(impl_->moving(), s, impl_->data);
}

const StepReport& MujocoPlant::step(const VectorXd& targets, const StepInput& input, double dt) {
  Impl& p = *impl_;
  p.check_input(targets, input, dt);
  p.begin_report();
  const double h = dt / p.steps;
  const VectorXd& delayed = p.delay.step(targets, dt);
  const bool moves = input.floor || !input.bumps.empty();
  const double begin = p.d->time;
  for (int i = 0; i < p.steps; ++i)
    p.step(delayed, i > 0 && moves ? later(input, i * h) : input, h);
  if (p.has_diverged())
    fail(ErrorCode::internal, p.model->name() + ": MuJoCo's state is huge or not finite " +
                                  text::fixed(begin, 3) + " s after its start");
  p.report_motors();
  p.finish_report();
  return p.report;
}

// If a number of its state is huge or not finite, MuJoCo counts a warning and continues from the
// first state of the model.
bool MujocoPlant::Impl::has_diverged() const {
  const auto happened = [&](mjtWarning warning) { return d->warning[warning].number > 0; };
  return happened(mjWARN_BADQPOS) || happened(mjWARN_BADQVEL) || happened(mjWARN_BADQACC) ||
         happened(mjWARN_BADCTRL) || !state.theta.allFinite() || !state.base.position.allFinite();
}

// The second half of MuJoCo's step. The integrator Euler of MuJoCo takes the damping of the joints
// at the end of the step, but not that of the actuators. The damping of the servos is therefore
// counted as damping of the joints while the step is integrated. The integrator "implicit" would
// take both at the end, too, but it also differentiates the Coriolis forces of the whole robot,
// which takes two fifths of the time of a run.
void MujocoPlant::Impl::integrate() {
  mj_fwdActuation(m.get(), d.get());
  mj_fwdAcceleration(m.get(), d.get());
  mj_fwdConstraint(m.get(), d.get());
  mj_checkAcc(m.get(), d.get());
  Eigen::Map<VectorXd> damping(m->dof_damping, m->nv);
  mean = damping;
  for (int j = 0; j < model->dof_count(); ++j)
    damping[velocity[static_cast<size_t>(j)]] -= m->actuator_biasprm[mjNBIAS * j + 2];
  mj_Euler(m.get(), d.get());
  damping = mean;
}

void MujocoPlant::Impl::step(const VectorXd& targets, const StepInput& input, double h) {
  take_bumps(input.bumps);
  m->opt.timestep = h;
  limit_torques();
  Eigen::Map<VectorXd>(d->xfrc_applied, 6 * m->nbody).setZero();
  take_input(targets, input);
  place_floor();
  set_friction();
  before = Eigen::Map<const VectorXd>(d->qvel, m->nv);
  mj_step1(m.get(), d.get());
  soften_contacts(h);
  move_ground(h);
  integrate();
  find_loads(h);
  account(h);
  read_state();
  report.contact_iterations = std::max(report.contact_iterations, static_cast<int>(d->solver_iter));
  report_servos();
  report_contacts();
}

PlantKind mujoco_plant_kind(int steps) {
  return {"mujoco",
          [steps](const RobotModel& model, const ActuatorLimits& limits, const World& world) {
            return PlantInterface(MujocoPlant(model, limits, world, steps));
          }};
}

}  // namespace ayumi
