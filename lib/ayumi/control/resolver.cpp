// Unknown: dtheta. The anchored sole moves with the plan (at rest in stance), so the floating
// velocity is V = map dtheta + rigid(anchor motion). Rows of J_U, u: COG 3, other foot 6, trunk 3;
// angular rows are scaled by a length so that the damping treats them like metres.
// A joint at a limit takes rates away. Then the COG height gives way first, the trunk's attitude
// next: their rows are scaled down, so that the damping outweighs them. Feet and horizontal COG,
// which keep the robot upright, come last: only then the whole motion becomes slower.
#include "ayumi/control/resolver.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/weighted_solve.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kSoft = 0.003;  // of the rows of a task that gives way
constexpr double kMet = 0.002;   // of a task that does not [m/s]

Vector3d rotation_between(const Matrix3d& from, const Matrix3d& to) {
  return log_rotation(Eigen::Quaterniond(Matrix3d(to * from.transpose())));
}

/// Rows of a floating Jacobian per joint rate while the base moves with them: [B C] [base; 1].
template <typename Rows>
MatrixXd anchored(const Rows& rows, const Eigen::Matrix<double, 6, Eigen::Dynamic>& base) {
  MatrixXd result = rows.rightCols(base.cols());
  result.noalias() += rows.template leftCols<6>().lazyProduct(base);
  return result;
}

/// Joint rates for these tasks; a joint that would leave its position limits is held there and the
/// rest solved again, a joint too fast slows all down.
Resolution within_limits(const RobotModel& model, const ActuatorLimits& limits,
                         const RobotState& reference, MatrixXd J, VectorXd u,
                         const VectorXd& weight, VectorXd x0, double dt,
                         const ResolverOptions& options) {
  const int n = model.dof_count();
  Resolution result;
  for (int pass = 0; pass < 4; ++pass) {
    result.dtheta = weighted_least_norm(J, u, weight, x0, options.damping);
    bool changed = false;
    for (int j = 0; j < n; ++j) {
      const Dof& dof = model.dofs()[j];
      if (!dof.limited || std::find(result.held.begin(), result.held.end(), j) != result.held.end())
        continue;
      const double after = reference.theta[j] + dt * result.dtheta[j];
      const double stop = std::clamp(after, dof.lower, dof.upper);
      if (stop == after) continue;
      const double rate = (stop - reference.theta[j]) / dt;
      u -= J.col(j) * rate;
      J.col(j).setZero();
      x0[j] = rate;
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
  return result;
}

void soften(MatrixXd& J, VectorXd& u, int first, int count) {
  J.middleRows(first, count) *= kSoft;
  u.segment(first, count) *= kSoft;
}

/// Whether the rates do the tasks; softened rows count as little as they weigh.
bool meets(const MatrixXd& J, const VectorXd& u, const VectorXd& dtheta) {
  return (J * dtheta - u).cwiseAbs().maxCoeff() < kMet;
}

}  // namespace

Resolution resolve(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, RobotData& data, Side anchor,
                   const Vector3d& cog_velocity, const CommandSample& command,
                   const CommandSample& next, double dt, const VectorXd& weight,
                   const ResolverOptions& options) {
  const int n = model.dof_count();
  const Side free = other(anchor);
  const int a = static_cast<int>(anchor), f = static_cast<int>(free);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> base =
      anchored_velocity_map(model, data, anchor).topRows<6>();

  // Motion of the planned anchor, as the rigid motion it gives to the whole robot.
  const Vector3d anchor_velocity =
      (next.feet[a].translation() - command.feet[a].translation()) / dt;
  const Vector3d anchor_rate =
      rotation_between(command.feet[a].linear(), next.feet[a].linear()) / dt;
  auto carried = [&](const Vector3d& point) -> Vector3d {
    return anchor_velocity + anchor_rate.cross(point - command.feet[a].translation());
  };

  MatrixXd J(12, n);
  VectorXd u(12);
  J.topRows<3>() = anchored(cog_jacobian_floating(model, data), base);
  u.head<3>() = cog_velocity - carried(data.cog);

  const Isometry3d foot = sole_pose(model, data, free);
  const MatrixXd foot_rows =
      anchored(body_jacobian(model, data, model.sole(free).body, foot.translation()), base);
  const double length = options.angular_length;
  J.middleRows<3>(3) = foot_rows.topRows<3>();
  J.middleRows<3>(6) = length * foot_rows.bottomRows<3>();
  u.segment<3>(3) = (next.feet[f].translation() - command.feet[f].translation()) / dt +
                    options.foot_rate * (command.feet[f].translation() - foot.translation()) -
                    carried(foot.translation());
  u.segment<3>(6) =
      length *
      (rotation_between(command.feet[f].linear(), next.feet[f].linear()) / dt +
       options.foot_rate * rotation_between(foot.linear(), command.feet[f].linear()) - anchor_rate);

  // Trunk: attitude and angular velocity of the commanded posture.
  const int trunk = model.trunk_body();
  const MatrixXd trunk_rows =
      anchored(body_jacobian(model, data, trunk, data.base_position + data.position[trunk]), base);
  Matrix3d commanded = command.state.base.attitude.toRotationMatrix();
  Vector3d commanded_rate = command.state.base_angular_velocity;
  if (trunk != 0) {
    RobotData planned(model);
    update_velocities(model, command.state, planned);
    commanded = planned.rotation[trunk];
    commanded_rate = planned.angular_velocity[trunk];
  }
  J.bottomRows<3>() = length * trunk_rows.bottomRows<3>();
  u.tail<3>() = length * (commanded_rate - anchor_rate +
                          options.trunk_rate * rotation_between(data.rotation[trunk], commanded));

  const VectorXd bias =
      command.state.dtheta + options.posture_rate * (command.state.theta - reference.theta);

  Resolution result;
  for (const Tasks yielding :
       {Tasks{}, Tasks{.height = true}, Tasks{.height = true, .trunk = true}}) {
    MatrixXd rows = J;
    VectorXd wanted = u;
    if (yielding.height) soften(rows, wanted, 2, 1);
    if (yielding.trunk) soften(rows, wanted, 9, 3);
    Resolution attempt =
        within_limits(model, limits, reference, rows, wanted, weight, bias, dt, options);
    if (yielding.height) {  // what made it yield is told
      attempt.held.insert(attempt.held.end(), result.held.begin(), result.held.end());
      std::sort(attempt.held.begin(), attempt.held.end());
      attempt.held.erase(std::unique(attempt.held.begin(), attempt.held.end()), attempt.held.end());
      if (attempt.limiting_dof < 0) attempt.limiting_dof = result.limiting_dof;
    }
    attempt.yielding = yielding;
    result = attempt;
    if (!options.in_order) break;
    if (result.scale == 1 && (result.held.empty() || meets(rows, wanted, result.dtheta))) break;
  }
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
