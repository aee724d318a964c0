// Servo: torque = clamp(kp (target - theta)) - kd dtheta, the damping as implicit joint damping.
// The text given to MuJoCo's compiler holds the tree, soles and servos; masses and places are then
// set exactly. MuJoCo's free joint has its angular velocity in body axes.
#include "ayumi/plant_mujoco/mujoco_plant.hpp"

#include <mujoco/mujoco.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/any_plant.hpp"
#include "ayumi/sim/contact_points.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Axes = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

namespace {

constexpr double kCorner = 0.0005;  // radius of the ball at a corner [m]
constexpr double kLargest = 1e6;    // number that is taken for one [SI]

std::string triple(const Vector3d& v) {
  return text::exact(v.x()) + " " + text::exact(v.y()) + " " + text::exact(v.z());
}

std::string quadruple(const Quaterniond& q) {
  return text::exact(q.w()) + " " + text::exact(q.x()) + " " + text::exact(q.y()) + " " +
         text::exact(q.z());
}

std::string point_name(size_t i) { return "point" + std::to_string(i); }

// A sole's corner touches where the bottom of its ball is while the sole is flat.
std::string point_text(const RobotModel& model, const ContactPoint& point, size_t i) {
  const double radius = std::max(point.radius, kCorner);
  Vector3d center = point.position;
  if (point.side >= 0)
    center += kCorner * model.sole(static_cast<Side>(point.side)).frame.linear().col(2);
  return "<geom name='" + point_name(i) + "' type='sphere' size='" + text::exact(radius) +
         "' pos='" + triple(center) + "' contype='1' conaffinity='2'/>";
}

std::string body_text(const RobotModel& model, const std::vector<ContactPoint>& points, int index) {
  const Body& body = model.bodies()[static_cast<size_t>(index)];
  std::string joint = "<freejoint/>";
  if (body.parent >= 0) {
    const Dof& dof = model.dofs()[static_cast<size_t>(body.dof)];
    joint = "<joint name='joint" + std::to_string(body.dof) + "' type='" +
            (body.prismatic ? "slide" : "hinge") + "' axis='" + triple(body.axis) + "' damping='" +
            text::exact(dof.servo.viscous) + "' armature='" + text::exact(dof.servo.rotor_inertia) +
            "' frictionloss='" + text::exact(dof.servo.coulomb) + "'";
    if (dof.limited)
      joint +=
          " limited='true' range='" + text::exact(dof.lower) + " " + text::exact(dof.upper) + "'";
    joint += "/>";
  }
  std::string out = "<body name='body" + std::to_string(index) + "'>" + joint +
                    "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
  for (size_t i = 0; i < points.size(); ++i)
    if (points[i].body == index) out += point_text(model, points[i], i);
  for (size_t i = 0; i < model.bodies().size(); ++i)
    if (model.bodies()[i].parent == index) out += body_text(model, points, static_cast<int>(i));
  return out + "</body>";
}

std::string model_text(const RobotModel& model, const std::vector<ContactPoint>& points,
                       const ActuatorLimits& limits, const World& world) {
  const Quaterniond slope = exp_rotation({world.slope.x(), world.slope.y(), 0});
  std::string out =
      "<mujoco><compiler angle='radian' boundmass='0'/><option gravity='0 0 " +
      text::exact(-kGravity) +
      "' integrator='implicit' cone='elliptic' solver='Newton' impratio='10' tolerance='1e-10' "
      "iterations='100'/>"
      "<default><geom condim='3' solref='0.004 1' solimp='0.95 0.99 0.001' friction='" +
      text::exact(world.friction) +
      " 0 0'/></default><worldbody><geom name='ground' type='plane' size='0 0 1' pos='" +
      triple(slope * Vector3d(0, 0, world.height)) + "' quat='" + quadruple(slope) +
      "' contype='2' conaffinity='1'/>" + body_text(model, points, 0) + "</worldbody><actuator>";
  for (int j = 0; j < model.dof_count(); ++j) {
    const std::string kp = text::exact(model.dofs()[static_cast<size_t>(j)].servo.kp);
    out += "<general joint='joint" + std::to_string(j) + "' gainprm='" + kp +
           "' biastype='affine' biasprm='0 -" + kp + " -" +
           text::exact(model.dofs()[static_cast<size_t>(j)].servo.kd) + "'";
    if (std::isfinite(limits.peak_torque[j]))
      out += " forcelimited='true' forcerange='" + text::exact(-limits.peak_torque[j]) + " " +
             text::exact(limits.peak_torque[j]) + "'";
    out += "/>";
  }
  return out + "</actuator></mujoco>";
}

using Model = std::unique_ptr<mjModel, void (*)(mjModel*)>;
using Data = std::unique_ptr<mjData, void (*)(mjData*)>;

Model compile(const std::string& robot, const std::string& xml) {
  const auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  char error[1000] = "could not take the text";
  Model model(nullptr, mj_deleteModel);
  if (mj_makeEmptyFileVFS(vfs.get(), "robot.xml", static_cast<int>(xml.size())) == 0) {
    const int file = mj_findFileVFS(vfs.get(), "robot.xml");
    std::memcpy(vfs->filedata[file], xml.data(), xml.size());
    model.reset(mj_loadXML("robot.xml", vfs.get(), error, sizeof error));
  }
  mj_deleteVFS(vfs.get());
  if (!model) fail(ErrorCode::bad_model, robot + ": MuJoCo: " + error);
  return model;
}

void set_quaternion(mjtNum* to, const Quaterniond& q) {
  to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
}

}  // namespace

struct MujocoPlant::Impl {
  Impl(const RobotModel& robot, const ActuatorLimits& actuators, Model compiled)
      : model(&robot),
        limits(actuators),
        m(std::move(compiled)),
        d(mj_makeData(m.get()), mj_deleteData) {}
  Impl(const Impl& o)
      : model(o.model),
        limits(o.limits),
        m(mj_copyModel(nullptr, o.m.get()), mj_deleteModel),
        d(mj_copyData(nullptr, o.m.get(), o.d.get()), mj_deleteData),
        points(o.points),
        velocity(o.velocity),
        body(o.body),
        point_of(o.point_of),
        state(o.state),
        data(o.data),
        report(o.report) {}

  void set_exact_numbers();
  void read_state();
  void apply(const ExternalWrench& w);
  void check_input(const VectorXd& targets, const StepInput& input, double dt) const;
  void limit_torques();
  void report_servos();
  void report_contacts();

  const RobotModel* model;
  ActuatorLimits limits;
  Model m;
  Data d;
  std::vector<ContactPoint> points;
  std::vector<int> velocity, body;  // MuJoCo's index of each dof and body
  std::vector<int> point_of;        // geom -> point; -1: none
  RobotState state;
  RobotData data{*model};
  StepReport report;
};

void MujocoPlant::Impl::set_exact_numbers() {
  const std::vector<Body>& bodies = model->bodies();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const int id = mj_name2id(m.get(), mjOBJ_BODY, ("body" + std::to_string(i)).c_str());
    body.push_back(id);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(bodies[i].inertia.about_com);
    Matrix3d axes = principal.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) *= -1;
    m->body_mass[id] = bodies[i].inertia.mass;
    Eigen::Map<Vector3d>(m->body_ipos + 3 * id) = bodies[i].inertia.com;
    Eigen::Map<Vector3d>(m->body_inertia + 3 * id) = principal.eigenvalues();
    set_quaternion(m->body_iquat + 4 * id, Quaterniond(axes));
    m->body_sameframe[id] = 0;
    m->body_simple[id] = 0;
    if (bodies[i].parent < 0) continue;
    Eigen::Map<Vector3d>(m->body_pos + 3 * id) = bodies[i].placement.translation();
    set_quaternion(m->body_quat + 4 * id, Quaterniond(bodies[i].placement.linear()));
  }
  for (int i = 0; i < m->nv; ++i) m->dof_simplenum[i] = 0;
  mj_setConst(m.get(), d.get());
  for (int j = 0; j < model->dof_count(); ++j)
    velocity.push_back(
        m->jnt_dofadr[mj_name2id(m.get(), mjOBJ_JOINT, ("joint" + std::to_string(j)).c_str())]);
  point_of.assign(static_cast<size_t>(m->ngeom), -1);
  for (size_t i = 0; i < points.size(); ++i) {
    point_of[static_cast<size_t>(mj_name2id(m.get(), mjOBJ_GEOM, point_name(i).c_str()))] =
        static_cast<int>(i);
    if (points[i].side >= 0)
      report.soles[points[i].side].resize(static_cast<size_t>(points[i].vertex) + 1);
  }
}

void MujocoPlant::Impl::read_state() {
  state.base.position = Eigen::Map<const Vector3d>(d->qpos);
  state.base.attitude = Quaterniond(d->qpos[3], d->qpos[4], d->qpos[5], d->qpos[6]).normalized();
  state.base_velocity = Eigen::Map<const Vector3d>(d->qvel);
  state.base_angular_velocity = state.base.attitude * Eigen::Map<const Vector3d>(d->qvel + 3);
  for (int j = 0; j < model->dof_count(); ++j) {
    const int column = velocity[static_cast<size_t>(j)];
    state.theta[j] = d->qpos[column + 1];  // one quaternion before it
    state.dtheta[j] = d->qvel[column];
  }
  update_velocities(*model, state, data);
}

void MujocoPlant::Impl::apply(const ExternalWrench& w) {
  const int id = body[static_cast<size_t>(w.body < 0 ? model->trunk_body() : w.body)];
  const Vector3d point = w.body < 0 ? data.cog : w.point;
  const Vector3d at = Eigen::Map<const Vector3d>(d->xipos + 3 * id);
  Eigen::Map<Vector3d>(d->xfrc_applied + 6 * id) += w.force;
  Eigen::Map<Vector3d>(d->xfrc_applied + 6 * id + 3) += w.torque + (point - at).cross(w.force);
}

// A motor cannot push a joint beyond its speed limit, as in Plant.
void MujocoPlant::Impl::limit_torques() {
  for (int j = 0; j < model->dof_count(); ++j) {
    if (!m->actuator_forcelimited[j]) continue;
    for (int end = 0; end < 2; ++end) {
      const double direction = end == 0 ? -1.0 : 1.0;
      m->actuator_forcerange[2 * j + end] =
          direction * available_torque(limits, j, state.dtheta[j], direction);
    }
  }
}

void MujocoPlant::Impl::report_servos() {
  report.saturated.clear();
  for (int j = 0; j < model->dof_count(); ++j) {
    const double drive = d->actuator_force[j];
    report.torque[j] = drive;
    if (m->actuator_forcelimited[j] &&
        (drive <= m->actuator_forcerange[2 * j] || drive >= m->actuator_forcerange[2 * j + 1]))
      report.saturated.push_back(j);
  }
}

void MujocoPlant::Impl::report_contacts() {
  for (std::vector<SoleForce>& sole : report.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report.max_penetration = 0;
  report.body_contact = false;
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& contact = d->contact[i];
    const int index = point_of[static_cast<size_t>(contact.geom2)];
    if (index < 0) continue;
    const ContactPoint& point = points[static_cast<size_t>(index)];
    mjtNum force[6];
    mj_contactForce(m.get(), d.get(), i, force);
    if (point.side < 0) {
      report.body_contact |= force[0] > 0;
      continue;
    }
    SoleForce& cell = report.soles[point.side][static_cast<size_t>(point.vertex)];
    cell.position = Eigen::Map<const Vector3d>(contact.pos);
    cell.force = Axes(contact.frame).transpose() * Eigen::Map<const Vector3d>(force);
    cell.gap = contact.dist;
    report.max_penetration = std::max(report.max_penetration, -contact.dist);
  }
}

void MujocoPlant::Impl::check_input(const VectorXd& targets, const StepInput& input,
                                    double dt) const {
  const auto complain = [&](const std::string& what) {
    fail(ErrorCode::usage, model->name() + ": " + what + ", " + text::fixed(d->time, 3) +
                               " s after the plant's start");
  };
  const auto sound = [](const auto& v) { return v.allFinite() && v.norm() < kLargest; };
  if (!(dt > 0 && dt < 1)) complain("step length " + text::brief(dt) + " s is not within 0..1 s");
  if (targets.size() != model->dof_count() || !sound(targets))
    complain("the servo targets are not " + std::to_string(model->dof_count()) + " finite numbers");
  for (const ExternalWrench& w : input.wrenches)
    if (!(sound(w.force) && sound(w.torque) && sound(w.point)))
      complain("an external force is not a finite number below 1e6");
  if (!input.payloads.empty() || !input.joints.empty() || input.friction || !input.bumps.empty() ||
      input.floor)
    fail(ErrorCode::bad_pattern,
         "the MuJoCo plant knows impulses, forces and torques only; leave the other disturbances "
         "out, or use Ayumi's own plant");
}

void refuse_uneven(const World& world) {
  if (!world.blocks.empty() || !world.patches.empty() || !world.fields.empty() ||
      !world.motions.empty())
    fail(ErrorCode::bad_pattern,
         "the MuJoCo plant knows one plane at rest with one friction; leave steps, bumps, field, "
         "patches and motion out of the world, or use Ayumi's own plant");
}

MujocoPlant::MujocoPlant(const RobotModel& model, const ActuatorLimits& limits,
                         const World& world) {
  if (static_cast<int>(model.bodies().size()) != model.dof_count() + 1)
    fail(ErrorCode::bad_model, model.name() + ": the MuJoCo plant knows no mimic joints");
  for (const Dof& dof : model.dofs())
    if (dof.servo.kp <= 0)
      fail(ErrorCode::bad_model,
           model.name() + ": joint " + dof.name + " has no servo (kp); give it one in the sidecar");
  refuse_uneven(world);
  const std::vector<ContactPoint> points = contact_points(model);
  impl_ = std::make_unique<Impl>(model, limits,
                                 compile(model.name(), model_text(model, points, limits, world)));
  impl_->points = points;
  impl_->set_exact_numbers();
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
  const VectorXd all = (VectorXd(12 + 2 * s.theta.size()) << s.base.position, s.base_velocity,
                        s.base_angular_velocity, s.base.attitude.vec(), s.theta, s.dtheta)
                           .finished();
  if (!(all.allFinite() && all.cwiseAbs().maxCoeff() < kLargest))
    fail(ErrorCode::usage,
         impl_->model->name() + ": the plant's state is not made of finite numbers below 1e6");
  mjData* d = impl_->d.get();
  mj_resetData(impl_->m.get(), d);
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
  update_velocities(*impl_->model, s, impl_->data);
}

const StepReport& MujocoPlant::step(const VectorXd& targets, const StepInput& input, double dt) {
  Impl& p = *impl_;
  p.check_input(targets, input, dt);
  mjData* d = p.d.get();
  p.m->opt.timestep = dt;
  p.limit_torques();
  Eigen::Map<VectorXd>(d->ctrl, p.m->nu) = targets;
  Eigen::Map<VectorXd>(d->xfrc_applied, 6 * p.m->nbody).setZero();
  for (const ExternalWrench& w : input.wrenches) p.apply(w);
  mj_step(p.m.get(), d);
  p.read_state();
  if (!p.state.theta.allFinite() || !p.state.base.position.allFinite())
    fail(ErrorCode::internal, p.model->name() + ": MuJoCo left the finite numbers " +
                                  text::fixed(d->time, 3) + " s after its start");
  p.report.contact_iterations = d->solver_iter;
  p.report_servos();
  p.report_contacts();
  return p.report;
}

PlantKind mujoco_plant_kind() {
  return {"mujoco", [](const RobotModel& model, const ActuatorLimits& limits, const World& world) {
            return AnyPlant(MujocoPlant(model, limits, world));
          }};
}

}  // namespace ayumi
