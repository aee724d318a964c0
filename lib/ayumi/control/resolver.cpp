// Unknown: dtheta. The anchored sole moves with the plan (at rest in stance), so the floating
// velocity is V = map dtheta + rigid(anchor motion). Rows of J_U, u: COG 3, other foot 6, trunk 3;
// angular rows are scaled by a length so that the damping treats them like metres.
// A joint at a limit takes rates away. Then the COG height gives way first, the trunk's attitude
// next: their rows are scaled down, so that the damping outweighs them. Feet and horizontal COG,
// which keep the robot upright, come last: only then the whole motion becomes slower.
#include "ayumi/control/resolver.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kSoft = 0.003;  // of the rows of a task that gives way
constexpr double kMet = 0.002;   // of a task that does not [m/s]

Vector3d rotation_between(const Matrix3d& from, const Matrix3d& to) {
  return log_rotation(Eigen::Quaterniond(Matrix3d(to * from.transpose())));
}

/// Adds what a unit rate of every joint from the root to `body` gives a point at p (from the base
/// origin) on it, times `sign`: linear velocity from row `linear` on where that is not negative,
/// angular velocity times `length` from row `angular` on.
void add_chain(const RobotModel& model, const RobotData& data, int body, const Vector3d& p,
               double sign, int linear, int angular, double length, BodyTasks& tasks) {
  for (int i = body; i > 0; i = model.bodies()[i].parent) {
    const Body& b = model.bodies()[i];
    const Vector3d s = sign * b.ratio * data.axis[i];
    double* column = tasks.J.data() + BodyTasks::kRows * b.dof;
    if (linear >= 0)
      Eigen::Map<Vector3d>(column + linear) +=
          b.prismatic ? s : Vector3d(s.cross(p - data.position[i]));
    if (!b.prismatic) Eigen::Map<Vector3d>(column + angular) += length * s;
  }
}

/// Joint rates for work.softened; a joint that would leave its position limits is held there and
/// the rest solved again, a joint too fast slows all down.
void within_limits(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, const VectorXd& weight, double dt,
                   const ResolverOptions& options, ResolverWork& work, Resolution& result) {
  const int n = model.dof_count();
  result.scale = 1;
  result.limiting_dof = -1;
  result.held.clear();
  const BodyTasks* tasks = &work.softened;
  work.start = work.bias;
  for (int pass = 0; pass < 4; ++pass) {
    solve_tasks(*tasks, weight, work.start, options.damping, work.weighted, result.dtheta);
    bool changed = false;
    for (int j = 0; j < n; ++j) {
      const Dof& dof = model.dofs()[j];
      if (!dof.limited || std::find(result.held.begin(), result.held.end(), j) != result.held.end())
        continue;
      const double after = reference.theta[j] + dt * result.dtheta[j];
      const double stop = std::clamp(after, dof.lower, dof.upper);
      if (stop == after) continue;
      const double rate = (stop - reference.theta[j]) / dt;
      if (tasks == &work.softened) {
        work.moving = work.softened;
        tasks = &work.moving;
      }
      work.moving.u -= work.moving.J.col(j) * rate;
      work.moving.J.col(j).setZero();
      work.start[j] = rate;
      result.held.push_back(j);
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

void soften(BodyTasks& tasks, int first, int count) {
  tasks.J.middleRows(first, count) *= kSoft;
  tasks.u.segment(first, count) *= kSoft;
}

/// Whether the rates do the tasks; softened rows count as little as they weigh.
bool meets(const BodyTasks& tasks, const VectorXd& dtheta) {
  return (tasks.J.lazyProduct(dtheta) - tasks.u).cwiseAbs().maxCoeff() < kMet;
}

}  // namespace

void resolve(const RobotModel& model, const ActuatorLimits& limits, const RobotState& reference,
             RobotData& data, Side anchor, const Vector3d& cog_velocity,
             const CommandSample& command, const CommandSample& next, double dt,
             const VectorXd& weight, const ResolverOptions& options, ResolverWork& work,
             Resolution& result) {
  const int n = model.dof_count();
  const Side free = other(anchor);
  const int a = static_cast<int>(anchor), f = static_cast<int>(free);
  const int stance = model.sole(anchor).body;

  // Motion of the planned anchor, as the rigid motion it gives to the whole robot.
  const Vector3d anchor_velocity =
      (next.feet[a].translation() - command.feet[a].translation()) / dt;
  const Vector3d anchor_rate =
      rotation_between(command.feet[a].linear(), next.feet[a].linear()) / dt;
  auto carried = [&](const Vector3d& point) -> Vector3d {
    return anchor_velocity + anchor_rate.cross(point - command.feet[a].translation());
  };

  // Relative to the anchored sole: its own chain counts backwards.
  BodyTasks& tasks = work.tasks;
  BodyTasks::Vector& u = tasks.u;
  cog_jacobian(model, data, anchor, work.cog);
  tasks.J.resize(BodyTasks::kRows, n);
  tasks.J.topRows<3>() = work.cog;
  tasks.J.bottomRows<9>().setZero();
  u.head<3>() = cog_velocity - carried(data.cog);

  const Isometry3d foot = sole_pose(model, data, free);
  const double length = options.angular_length;
  const Vector3d foot_point = foot.translation() - data.base_position;
  add_chain(model, data, model.sole(free).body, foot_point, 1, 3, 6, length, tasks);
  add_chain(model, data, stance, foot_point, -1, 3, 6, length, tasks);
  u.segment<3>(3) = (next.feet[f].translation() - command.feet[f].translation()) / dt +
                    options.foot_rate * (command.feet[f].translation() - foot.translation()) -
                    carried(foot.translation());
  u.segment<3>(6) =
      length *
      (rotation_between(command.feet[f].linear(), next.feet[f].linear()) / dt +
       options.foot_rate * rotation_between(foot.linear(), command.feet[f].linear()) - anchor_rate);

  // Trunk: attitude and angular velocity of the commanded posture.
  const int trunk = model.trunk_body();
  add_chain(model, data, trunk, data.position[trunk], 1, -1, 9, length, tasks);
  add_chain(model, data, stance, data.position[trunk], -1, -1, 9, length, tasks);
  Matrix3d commanded = command.state.base.attitude.toRotationMatrix();
  Vector3d commanded_rate = command.state.base_angular_velocity;
  if (trunk != 0) {
    if (!work.planned) work.planned.emplace(model);
    update_velocities(model, command.state, *work.planned);
    commanded = work.planned->rotation[trunk];
    commanded_rate = work.planned->angular_velocity[trunk];
  }
  if (!options.lean.isZero(0)) commanded = exp_rotation(options.lean) * commanded;
  commanded_rate += options.lean_rate;
  u.tail<3>() = length * (commanded_rate - anchor_rate +
                          options.trunk_rate * rotation_between(data.rotation[trunk], commanded));

  work.bias = command.state.dtheta + options.posture_rate * (command.state.theta - reference.theta);

  result.held.clear();
  result.limiting_dof = -1;
  for (const Tasks yielding :
       {Tasks{}, Tasks{.height = true}, Tasks{.height = true, .trunk = true}}) {
    work.softened = tasks;
    if (yielding.height) soften(work.softened, 2, 1);
    if (yielding.trunk) soften(work.softened, 9, 3);
    Resolution& attempt = work.attempt;
    within_limits(model, limits, reference, weight, dt, options, work, attempt);
    if (yielding.height) {  // what made it yield is told
      attempt.held.insert(attempt.held.end(), result.held.begin(), result.held.end());
      std::sort(attempt.held.begin(), attempt.held.end());
      attempt.held.erase(std::unique(attempt.held.begin(), attempt.held.end()), attempt.held.end());
      if (attempt.limiting_dof < 0) attempt.limiting_dof = result.limiting_dof;
    }
    attempt.yielding = yielding;
    std::swap(result, attempt);
    if (!options.in_order) break;
    if (result.scale == 1 && (result.held.empty() || meets(work.softened, result.dtheta))) break;
  }
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
  std::string yields;
  if (resolution.yielding.height) yields = "the COG height";
  if (resolution.yielding.trunk) yields += " and the trunk attitude";
  if (resolution.scale < 1)
    yields = (yields.empty() ? "" : yields + " give way and ") + "the whole motion becomes slower";
  else if (!yields.empty())
    yields += resolution.yielding.trunk ? " give way" : " gives way";
  else
    yields = "no task gives way";
  std::vector<std::string> notes;
  if (resolution.limiting_dof >= 0)
    notes.push_back("speed limit of " + model.dofs()[resolution.limiting_dof].name + ": " + yields);
  for (const int j : resolution.held)
    notes.push_back("position limit of " + model.dofs()[j].name + ": " + yields);
  return notes;
}

}  // namespace ayumi
