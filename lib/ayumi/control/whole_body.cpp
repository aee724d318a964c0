// Solves (22): among all joint rates that do the task J_U x = u, which includes the reference
// velocity of the COG, it takes those nearest to the commanded rates in the norm W. (23) is the
// solution. A law without commanded rates (VIIP) uses (28)(29), which is the same problem with the
// bias 0. Here the bias also pulls the joints towards the posture that is commanded, or held. The
// anchored sole moves with the plan (at rest in stance), so the velocity of the floating base is V
// = map dtheta + rigid(anchor motion), where the map belongs to a sole at rest. Angular rows are
// scaled by a length so that the damping treats them like metres. A joint at a limit cannot move as
// fast as the task requires. Then the task of the COG height is reduced first, and that of the
// trunk's attitude next: their rows are scaled down, so that the damping outweighs them. The rows
// of the feet and of the horizontal COG, which keep the robot upright, are not scaled: if a joint
// is still too fast, the whole motion becomes slower.
#include "ayumi/control/whole_body.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/weighted_solve.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Factor on the rows of a task that is reduced. Chosen: its square, 1e-5, is the damping's share of
// the trace, so such rows have no more weight than the damping. Its effect is in constants.md.
constexpr double kSoftness = 0.003;

// Largest residual of a task that counts as fulfilled [m/s]: 2 um in each tick of 1 ms. Chosen:
// with bent knees, the residual that the damping leaves is smaller. Its effect is in constants.md.
constexpr double kDone = 0.002;

// Largest number of solutions of a task. After each of them, the joints that would leave their
// range are fixed, and the task is solved again for the other joints. Chosen: both knees and both
// ankles may reach their limits one after the other. No measured case changes between half and
// twice the value (constants.md).
constexpr int kLimitPasses = 4;

// Speed limit of the reference COG, as a multiple of omega z: 1.2 m/s on HOAP-1. Chosen: at this
// speed the DCM is outside every support; without a limit an integrator could run away. No measured
// case changes between half and twice the value (constants.md).
constexpr double kCogSpeedLimit = 0.8;

// Acceleration limit of the reference COG, as a multiple of g. Chosen: the force of a leg in its
// strongest motion, a landing; only an unstable law requires more. No measured case changes between
// half and twice the value (constants.md).
constexpr double kCogAccelerationLimit = 4;

// Deceleration of a joint that turns, before it reaches a position limit while one foot swings, as
// a multiple of g / z; of a joint that slides, as a multiple of g. Chosen: the tasks that a limit
// prevents are then reduced before the joint is there, and COG and feet are followed all the time.
// With 4.5 to 5.5, the worst push in the walk is 1.26 B with hoap1-strong; with 4, with 10 and
// without braking it is 1.20 B. Of 32 pushes, 15 become larger and 8 smaller, one of them by 0.6 B
// (docs/measurements/law.md, "Braking before position limits").
constexpr double kBraking = 5;

// A tilted foot counts as lying on the ground, and not as tipping over an edge, if its centre of
// pressure is farther than this from the nearest edge of the sole, as a share of the largest
// possible distance. Chosen: 5 mm on HOAP-1, twice the noise of its load cells; docs/theory.md, "A
// foot on a bump". Its effect is in constants.md.
constexpr double kInsideSole = 0.15;

// Time constant of the low pass of the tilt that the ankles compensate [s]. Chosen: stiff servos
// would otherwise follow the noise of the IMU. In the walk of HOAP-1 with its sensors' noise, the
// rms of ZMP - ref ZMP is 20.6 mm without the low pass, 8.4 mm with 0.01 s, 6.9 mm with 0.05 s and
// 7.0 mm with 0.1 s. The response to late sensors does not change. With 0.05 s the ankles yield
// less to a plate under half a sole than with 0.1 s.
constexpr double kTiltFilter = 0.1;

// Rate at which the joints return to their command when the robot is off the ground [1/s]. Chosen:
// in a jump of 0.03 m, the legs return by four fifths before they land, and they are soft enough.
// In jumps of HOAP-1, the largest force of the landing is 188 to 256 N with 10, 200 to 353 N with
// 20, and 256 to 403 N with 40. In open loop, it is 295 to 562 N.
constexpr double kFlightRate = 10;

// Damping of the turn that the joints of a hip make together [1]. Chosen: joints whose axes have
// come into one plane then turn by no more than a few times the tilt.
constexpr double kHipDamping = 1e-3;

// Smallest turn of a joint, as a share of the trunk's turn, with which the joint's limit bounds the
// trunk. Chosen: the joints of the hips turn by 1 to 1.3 times the trunk's turn. Other joints turn
// by less than 0.4; if they are at a limit, the remaining joints do the task without them.
constexpr double kTurnsTrunk = 0.5;

// Definition: bits for the limits by which a servo target was bounded.
constexpr char kTooFast = 1, kTooFar = 2;

Vector3d turn_between(const Matrix3d& from, const Matrix3d& to) {
  return log_rotation(Eigen::Quaterniond(Matrix3d(to * from.transpose())));
}

/// Adds the contribution of every joint from the root to `body`, at unit rate and times `sign`, to
/// the velocity of a point at p (from the base origin) on this body. The linear velocity is added
/// from row `linear` on, unless it is negative. The angular velocity times `length` is added from
/// row `angular` on.
void add_chain(const RobotModel& model, const RobotData& data, int body, const Vector3d& p,
               double sign, int linear, int angular, double length, StackedTask& task) {
  for (int i = body; i > 0; i = model.bodies()[i].parent) {
    const Body& b = model.bodies()[i];
    const Vector3d s = sign * b.ratio * data.axis[i];
    double* column = task.J.data() + StackedTask::kRows * b.dof;
    if (linear >= 0)
      Eigen::Map<Vector3d>(column + linear) +=
          b.prismatic ? s : Vector3d(s.cross(p - data.position[i]));
    if (!b.prismatic) Eigen::Map<Vector3d>(column + angular) += length * s;
  }
}

/// The largest rate at which a joint can still stop at `distance` with the deceleration `braking`,
/// if it begins to brake one tick later: rate dt + rate^2 / (2 braking) = distance. Beyond the
/// limit, and without braking, it is the rate that leads to the limit in one tick.
double braking_rate(double distance, double braking, double dt) {
  if (distance <= 0 || std::isinf(braking)) return distance / dt;
  return braking * (std::sqrt(dt * dt + 2 * distance / braking) - dt);
}

/// Joint rates for the given task. A joint that approaches a position limit may have at most
/// braking_rate(), or its rate of the plan if this is larger, and the rest is solved again. A joint
/// that is too fast slows down the whole motion.
void within_limits(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, const StackedTask& given, const VectorXd& weight,
                   const VectorXd& planned, double dt, const ResolverOptions& options,
                   ResolverWork& work, Resolution& result) {
  const int n = model.dof_count();
  result.scale = 1;
  result.limiting_dof = -1;
  result.held.clear();
  result.braking.clear();
  const StackedTask* task = &given;
  work.start = work.bias;
  for (int pass = 0; pass < kLimitPasses; ++pass) {
    solve_stacked_task(*task, weight, work.start, options.damping, work.weighted, result.dtheta);
    bool changed = false;
    for (int j = 0; j < n; ++j) {
      const Dof& dof = model.dofs()[j];
      if (!dof.limited || std::find(result.held.begin(), result.held.end(), j) != result.held.end())
        continue;
      const double braking = dof.prismatic ? options.sliding_braking : options.braking;
      const double up = dof.upper - reference.theta[j], down = reference.theta[j] - dof.lower;
      const double speed = std::abs(result.dtheta[j]);
      if (up >= 0 && down >= 0 &&
          speed * dt + speed * speed / (2 * braking) <= (result.dtheta[j] > 0 ? up : down))
        continue;
      const double least =
          -std::min(down / dt, std::max(braking_rate(down, braking, dt), -planned[j]));
      const double most = std::min(up / dt, std::max(braking_rate(up, braking, dt), planned[j]));
      // A joint beyond one of its limits returns in one tick.
      const double rate =
          least > most ? (down < 0 ? least : most) : std::clamp(result.dtheta[j], least, most);
      if (rate == result.dtheta[j]) continue;
      if (task == &given) {
        work.moving = given;
        task = &work.moving;
      }
      work.moving.u -= work.moving.J.col(j) * rate;
      work.moving.J.col(j).setZero();
      work.start[j] = rate;
      result.dtheta[j] = rate;  // for the last pass, after which nothing is solved again
      result.held.push_back(j);
      if (rate != up / dt && rate != -down / dt) result.braking.push_back(j);
      changed = true;
    }
    if (!changed) break;
  }
  for (int j = 0; j < n; ++j) {
    const double speed = options.speed_share * limits.speed[j];
    const double share = std::abs(result.dtheta[j]) > 0 ? speed / std::abs(result.dtheta[j]) : 2.0;
    if (share < result.scale) {
      result.scale = share;
      result.limiting_dof = j;
    }
  }
  result.dtheta *= result.scale;
}

/// Adds the joints `more` to `joints`, in rising order and each once.
void add_joints(std::vector<int>& joints, const std::vector<int>& more) {
  joints.insert(joints.end(), more.begin(), more.end());
  std::ranges::sort(joints);
  const auto [first, last] = std::ranges::unique(joints);
  joints.erase(first, last);
}

void soften(StackedTask& task, int first, int count) {
  task.J.middleRows(first, count) *= kSoftness;
  task.u.segment(first, count) *= kSoftness;
}

/// The residual of the task. Rows of a reduced task only count with their reduced weight.
StackedTask::Vector left_of(const StackedTask& task, const VectorXd& dtheta) {
  StackedTask::Vector done = StackedTask::Vector::Zero();
  kernels::best_kernels().multiply_add(task.J.data(), StackedTask::kRows,
                                       static_cast<int>(task.J.cols()), StackedTask::kRows,
                                       dtheta.data(), done.data());
  return done - task.u;
}

}  // namespace

// Equations (23) and (29).
void solve_stacked_task(const StackedTask& task, const VectorXd& w, const VectorXd& bias,
                        double damping, StackedTask::Rows& weighted, VectorXd& x) {
  constexpr int kRows = StackedTask::kRows;
  const kernels::Kernels& kernels = kernels::best_kernels();
  const int n = static_cast<int>(task.J.cols());
  weighted.resize(kRows, n);
  for (int j = 0; j < n; ++j) weighted.col(j) = task.J.col(j) * (1 / w[j]);
  Eigen::Matrix<double, kRows, kRows> A;
  // The product is symmetric, and only the part on and below the diagonal is read.
  for (int j = 0; j < kRows; j += 4)
    kernels.gram(weighted.data() + j, kRows, task.J.data() + j, kRows, n, kRows - j, 4,
                 A.data() + j * kRows + j, kRows);
  if (damping > 0) A.diagonal().array() += damping * A.trace() / kRows;
  StackedTask::Vector y = -task.u;  // this is -v of (23)
  kernels.multiply_add(task.J.data(), kRows, n, kRows, bias.data(), y.data());
  if (!kernels.solve_positive(A.data(), kRows, kRows, y.data())) {
    // This solution is for rows that contradict each other.
    x = weighted_least_norm(task.J, task.u, w, bias, damping);
    return;
  }
  x = bias;
  for (int j = 0; j < n; ++j) x[j] -= weighted.col(j).dot(y);
}

void resolve(const RobotModel& model, const ActuatorLimits& limits, const RobotState& reference,
             RobotData& data, Side anchor, const Vector3d& cog_velocity,
             const CommandSample& command, const CommandSample& next, double dt,
             const VectorXd& weight, const ResolverOptions& options, ResolverWork& work,
             Resolution& result) {
  const int n = model.dof_count();
  const Side free = other(anchor);
  const int a = static_cast<int>(anchor), f = static_cast<int>(free);
  const int stance = model.sole(anchor).body;

  // The motion of the planned anchor, as a rigid motion of the whole robot.
  const Vector3d anchor_velocity =
      (next.feet[a].translation() - command.feet[a].translation()) / dt;
  const Vector3d anchor_rate = turn_between(command.feet[a].linear(), next.feet[a].linear()) / dt;
  auto carried = [&](const Vector3d& point) -> Vector3d {
    return anchor_velocity + anchor_rate.cross(point - command.feet[a].translation());
  };

  // COG: J_G of (13) and ref dp_G. All rows are relative to the anchored sole, so the joints of its
  // leg count with the opposite sign.
  StackedTask& task = work.task;
  StackedTask::Vector& u = task.u;
  cog_jacobian(model, data, anchor, work.cog);
  task.J.resize(StackedTask::kRows, n);
  task.J.topRows<3>() = Eigen::Map<const Eigen::Matrix3Xd>(work.cog.data(), 3, n);
  task.J.bottomRows<9>().setZero();
  u.head<3>() = cog_velocity - carried(data.cog);

  // The rows of the other foot.
  const Isometry3d foot = sole_pose(model, data, free);
  const double length = options.angular_length;
  const Vector3d foot_point = foot.translation() - data.base_position;
  add_chain(model, data, model.sole(free).body, foot_point, 1, 3, 6, length, task);
  add_chain(model, data, stance, foot_point, -1, 3, 6, length, task);
  u.segment<3>(3) = (next.feet[f].translation() - command.feet[f].translation()) / dt +
                    options.foot_rate * (command.feet[f].translation() - foot.translation()) -
                    carried(foot.translation());
  u.segment<3>(6) =
      length *
      (turn_between(command.feet[f].linear(), next.feet[f].linear()) / dt +
       options.foot_rate * turn_between(foot.linear(), command.feet[f].linear()) - anchor_rate);

  // The rows of the trunk: the attitude and angular velocity of the commanded posture.
  const int trunk = model.trunk_body();
  add_chain(model, data, trunk, data.position[trunk], 1, -1, 9, length, task);
  add_chain(model, data, stance, data.position[trunk], -1, -1, 9, length, task);
  Matrix3d commanded = command.state.base.attitude.toRotationMatrix();
  Vector3d commanded_rate = command.state.base_angular_velocity;
  if (trunk != 0) {
    if (!work.planned) work.planned.emplace(model);
    update_velocities(model, command.state, *work.planned);
    commanded = work.planned->rotation[trunk];
    commanded_rate = work.planned->angular_velocity[trunk];
  }
  if (!options.turn.lean.isZero(0)) commanded = exp_rotation(options.turn.lean) * commanded;
  commanded_rate += options.turn.lean_rate;
  u.tail<3>() = length * (commanded_rate - anchor_rate +
                          options.trunk_rate * turn_between(data.rotation[trunk], commanded));

  // (22): the commanded rates, which are zero in (28), and the pull towards the posture.
  work.bias = command.state.dtheta + options.posture_rate * (command.state.theta - reference.theta);
  if (options.turn.joints.size() == n)
    work.bias += options.turn.joint_rates + options.posture_rate * options.turn.joints;

  result.held.clear();
  result.braking.clear();
  result.limiting_dof = -1;
  for (const YieldingTasks yielding : {YieldingTasks{}, YieldingTasks{.height = true},
                                       YieldingTasks{.height = true, .trunk = true}}) {
    if (yielding.height) work.softened = task;
    const StackedTask& asked = yielding.height ? work.softened : task;
    if (yielding.height) soften(work.softened, 2, 1);
    if (yielding.trunk) soften(work.softened, 9, 3);
    Resolution& attempt = work.attempt;
    within_limits(model, limits, reference, asked, weight, command.state.dtheta, dt, options, work,
                  attempt);
    if (yielding.height) {  // the joints because of which the task was reduced stay recorded
      add_joints(attempt.held, result.held);
      add_joints(attempt.braking, result.braking);
      if (attempt.limiting_dof < 0) attempt.limiting_dof = result.limiting_dof;
    }
    attempt.yielding = yielding;
    std::swap(result, attempt);
    if (!options.in_order) break;
    if (result.scale == 1 &&
        (result.held.empty() || left_of(asked, result.dtheta).cwiseAbs().maxCoeff() < kDone))
      break;
  }
  work.left = left_of(task, result.dtheta);
  result.residuals.cog = work.left.head<3>().norm();
  result.residuals.foot = work.left.segment<3>(3).norm();
  result.residuals.foot_turn = work.left.segment<3>(6).norm() / length;
  result.residuals.trunk = work.left.tail<3>().norm() / length;
}

Resolution resolve(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, RobotData& data, Side anchor,
                   const Vector3d& cog_velocity, const CommandSample& command,
                   const CommandSample& next, double dt, const VectorXd& weight,
                   const ResolverOptions& options) {
  ResolverWork work;
  Resolution result;
  resolve(model, limits, reference, data, anchor, cog_velocity, command, next, dt, weight, options,
          work, result);
  return result;
}

std::vector<std::string> limit_notes(const RobotModel& model, const Resolution& resolution) {
  std::string effect;
  if (resolution.yielding.height) effect = "the COG height";
  if (resolution.yielding.trunk) effect += " and the trunk attitude";
  if (!effect.empty())
    effect += resolution.yielding.trunk ? " deviate from the plan" : " deviates from the plan";
  if (resolution.scale < 1)
    effect += std::string(effect.empty() ? "" : ", and ") + "the whole motion becomes slower";
  else if (effect.empty())
    effect = "the other joints compensate, so the plan is still followed";
  std::vector<std::string> notes;
  if (resolution.limiting_dof >= 0)
    notes.push_back(model.dofs()[resolution.limiting_dof].name +
                    " is at its speed limit: " + effect);
  for (const int j : resolution.held)
    notes.push_back(model.dofs()[j].name +
                    (std::ranges::find(resolution.braking, j) == resolution.braking.end()
                         ? " is at its position limit: "
                         : " brakes before its position limit: ") +
                    effect);
  return notes;
}

ReferenceBody::ReferenceBody(const RobotModel& model, const ActuatorLimits& limits, double dt,
                             const RobotState& start, const VectorXd& target,
                             const ResolverOptions& options)
    : model_(&model),
      limits_(limits),
      options_(options),
      dt_(dt),
      data_(model),
      weight_(model.joint_weight()),
      lead_(velocity_lead(limits)),
      previous_target_(target),
      noted_(static_cast<size_t>(model.dof_count())),
      reference_(start) {}

void ReferenceBody::take_over(const Handover& handover) {
  reference_ = handover.reference;
  dcog_ = handover.dcog;
  previous_target_ = handover.target;
}

void ReferenceBody::anchor(Side side, const Eigen::Isometry3d& sole) {
  anchor_ = side;
  anchor_base(*model_, side, sole, reference_, data_);
}

// A foot that has tipped is turned back flat. A tilt that lasts belongs to the ground (or to the
// sensor) and is accepted like a lasting offset of the ZMP: levelling a foot that lies flat on a
// slope would lean the body downhill. A tipping foot carries its load on an edge of its sole. A
// foot that carries it inside its sole lies on a bump or a stone, and its tilt soon counts as that
// of the ground. The body above need not lean with one foot: the ankle yields.
const VectorXd& ReferenceBody::ankle_offsets(const Estimate& estimate, const AnkleLaw& law) {
  const bool lies = law.contact_tilt_time > 0 && estimate.stance_inside > kInsideSole;
  const auto share_of = [&](double time) { return time > 0 ? std::min(1.0, dt_ / time) : 0.0; };
  Vector3d& under = slope_[static_cast<int>(estimate.stance)];
  Vector3d& swing = slope_[static_cast<int>(other(estimate.stance))];
  under += share_of(lies ? law.contact_tilt_time : law.slope_time) * (estimate.foot_tilt - under);
  ground_ += share_of(law.slope_time) * (under - ground_);
  if (law.contact_tilt_time > 0)
    swing += share_of(law.contact_tilt_time) * (ground_ - swing);
  else
    swing = under;
  tipped_ += share_of(kTiltFilter) * (estimate.foot_tilt - under - tipped_);
  offsets_.setZero(model_->dof_count());
  for (Side side : {Side::left, Side::right}) {
    Vector3d turn = law.compliance * (slope_[static_cast<int>(side)] - ground_);
    if (side == estimate.stance) turn -= law.share * tipped_;
    const std::vector<int>& leg = model_->leg(side);
    for (size_t i = leg.size() >= 2 ? leg.size() - 2 : 0; i < leg.size(); ++i)
      offsets_[leg[i]] = data_.axis[model_->dofs()[leg[i]].body].dot(turn);
  }
  return offsets_;
}

TurnRoom ReferenceBody::turn_room() {
  TurnRoom room;
  StackedTask& task = work_.task;
  if (task.J.cols() == 0) return room;
  const StackedTask::Vector asked = task.u;
  work_.start.setZero(model_->dof_count());
  for (int axis = 0; axis < 2; ++axis) {
    task.u.setZero();
    task.u[9 + axis] = options_.angular_length;
    solve_stacked_task(task, weight_, work_.start, options_.damping, work_.weighted, turning_);
    for (int j = 0; j < model_->dof_count(); ++j) {
      const Dof& dof = model_->dofs()[j];
      const double rate = turning_[j];
      if (!dof.limited || std::abs(rate) < kTurnsTrunk) continue;
      const double up = std::max(0.0, dof.upper - reference_.theta[j]) / std::abs(rate);
      const double down = std::max(0.0, reference_.theta[j] - dof.lower) / std::abs(rate);
      room.above[axis] = std::min(room.above[axis], rate > 0 ? up : down);
      room.below[axis] = std::min(room.below[axis], rate > 0 ? down : up);
    }
  }
  task.u = asked;
  return room;
}

void ReferenceBody::advance(const CogReference& wanted, double z, const CommandSample& command,
                            const CommandSample& next, const VectorXd& offsets,
                            ControlOutput& out) {
  out.cog_reference = wanted;
  CogReference& ref = out.cog_reference;
  const double w = std::sqrt(kGravity / z);
  const double limit = kCogAccelerationLimit * kGravity;
  if (ref.ddcog.norm() > limit) ref.ddcog *= limit / ref.ddcog.norm();
  dcog_ += dt_ * ref.ddcog;
  const double speed = kCogSpeedLimit * w * z;
  if (dcog_.norm() > speed) dcog_ *= speed / dcog_.norm();
  ref.dcog = dcog_;

  // While both feet stand, turn_room() already bounds the turn of the trunk.
  options_.sliding_braking =
      command.support == Support::both ? ResolverOptions().braking : kBraking * kGravity;
  options_.braking = options_.sliding_braking / z;
  resolve(*model_, limits_, reference_, data_, anchor_, dcog_, command, next, dt_, weight_,
          options_, work_, resolution_);
  if (resolution_.limiting_dof >= 0 || !resolution_.held.empty())
    for (const std::string& note : limit_notes(*model_, resolution_)) out.notes.push_back(note);

  out.residuals = resolution_.residuals;
  out.weight = weight_;
  send(resolution_.dtheta, command, next, offsets, out);
}

void ReferenceBody::release(const CommandSample& command) {
  reference_.base = command.state.base;
  update_positions(*model_, reference_, data_);
  reference_.base.position += command.cog - data_.cog;
  move_base(reference_.base, data_);
}

// If the trunk tilts, the feet turn with it about the COG. The joints of the hip turn the legs
// back, so that the soles come down level and under the COG.
void ReferenceBody::fly(const Vector3d& tilt, const CommandSample& command,
                        const CommandSample& next, const VectorXd& offsets, ControlOutput& out) {
  work_.bias = command.state.theta;
  for (Side side : {Side::left, Side::right}) {
    const std::vector<int>& leg = model_->leg(side);
    Matrix3d axes = Matrix3d::Zero();
    for (int i = 0; i < std::min<int>(3, static_cast<int>(leg.size())); ++i)
      axes.col(i) = data_.axis[model_->dofs()[leg[i]].body];
    const Matrix3d damped = axes * axes.transpose() + kHipDamping * Matrix3d::Identity();
    const Vector3d turn = -axes.transpose() * solve_symmetric(damped, tilt);
    for (int i = 0; i < std::min<int>(3, static_cast<int>(leg.size())); ++i)
      work_.bias[leg[i]] += turn[i];
  }
  VectorXd& dtheta = work_.start;
  dtheta = command.state.dtheta + kFlightRate * (work_.bias - reference_.theta);
  for (int j = 0; j < dtheta.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double most = options_.speed_share * limits_.speed[j];
    dtheta[j] = std::clamp(dtheta[j], -most, most);
    if (dof.limited)
      dtheta[j] = std::clamp(dtheta[j], (dof.lower - reference_.theta[j]) / dt_,
                             (dof.upper - reference_.theta[j]) / dt_);
  }
  dcog_ = next.dcog;
  out.cog_reference.dcog = dcog_;
  out.residuals = {};
  out.weight.setZero(model_->dof_count());
  send(dtheta, command, next, offsets, out);
}

void ReferenceBody::send(const VectorXd& dtheta, const CommandSample& command,
                         const CommandSample& next, const VectorXd& offsets, ControlOutput& out) {
  // The posture of this tick with its base, and the rates that lead to the next posture.
  reference_.dtheta = dtheta;
  out.reference = reference_;
  reference_.theta += dt_ * dtheta;
  out.target = reference_.theta + lead_.cwiseProduct(dtheta) + offsets;
  bound_target(command, next, out);
}

// The feedforward and the ankles may require more of a joint than resolve() did. The targets of the
// plan with its velocity feedforward may move faster than the joint, for example where a leg lands;
// the law changes them by no more than the joint's speed limit. Each joint is noted once.
void ReferenceBody::bound_target(const CommandSample& command, const CommandSample& next,
                                 ControlOutput& out) {
  const auto hold = [&](int j, double low, double high, char what, const char* text) {
    double& target = out.target[j];
    if (target >= low && target <= high) return;
    target = std::clamp(target, low, high);
    if (noted_[static_cast<size_t>(j)] & what) return;
    noted_[static_cast<size_t>(j)] |= what;
    out.notes.push_back("the servo target of " + model_->dofs()[j].name + " is kept within the " +
                        text);
  };
  for (int j = 0; j < out.target.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double planned = next.state.theta[j] - command.state.theta[j] +
                           lead_[j] * (next.state.dtheta[j] - command.state.dtheta[j]);
    const double step = limits_.speed[j] * dt_, before = previous_target_[j];
    hold(j, before + std::min(planned, 0.0) - step, before + std::max(planned, 0.0) + step,
         kTooFast, "speed limit");
    if (dof.limited) hold(j, dof.lower, dof.upper, kTooFar, "position limit");
  }
  previous_target_ = out.target;
}

}  // namespace ayumi
