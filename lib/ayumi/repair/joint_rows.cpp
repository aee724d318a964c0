#include "ayumi/repair/joint_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/repair/motor_torque.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_of_joint(ConstraintGroup group) {
  return group >= ConstraintGroup::position && group <= ConstraintGroup::torque;
}

bool is_of_joint_angle(ConstraintGroup group) {
  return group >= ConstraintGroup::position && group <= ConstraintGroup::acceleration;
}

VectorXd joint_values(const ConstraintBlock& block, const PointState& state) {
  const CorrectedMotion& m = state.motion;
  const int i = block.item;
  switch (block.group) {
    case ConstraintGroup::position:
      return VectorXd::Constant(1, m.state.theta[i]);
    case ConstraintGroup::speed:
      return VectorXd::Constant(1, block.scale * m.state.dtheta[i]);
    case ConstraintGroup::acceleration:
      return VectorXd::Constant(1, block.scale * m.acceleration[6 + i]);
    default:
      return VectorXd::Constant(1, block.scale * state.torque[i]);
  }
}

std::array<MatrixXd, 3> joint_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                          const PointState& state) {
  std::array<MatrixXd, 3> by;
  if (block.group == ConstraintGroup::torque) {
    for (int k = 0; k < 3; ++k) by[k] = block.scale * state.torque_by[k].row(block.item);
    return by;
  }
  const int order = block.group == ConstraintGroup::position ? 0
                    : block.group == ConstraintGroup::speed  ? 1
                                                             : 2;
  by[order] = MatrixXd::Zero(1, model.velocity_count());
  by[order](0, 6 + block.item) = block.scale;
  return by;
}

namespace {

// The largest figures of a joint over the watched samples.
struct WatchedJoint {
  double position = 0;  // |theta - middle| over half the range
  double speed = 0, acceleration = 0;
};

WatchedJoint watched_joint(const std::vector<const CommandSample*>& samples, int i, bool limited,
                           double lower, double upper) {
  WatchedJoint most;
  for (const CommandSample* sample : samples) {
    const double theta = sample->state.theta[i];
    if (limited)
      most.position = std::max(most.position,
                               std::abs(theta - 0.5 * (lower + upper)) / (0.5 * (upper - lower)));
    most.speed = std::max(most.speed, std::abs(sample->state.dtheta[i]));
    most.acceleration = std::max(most.acceleration, std::abs(sample->acceleration[6 + i]));
  }
  return most;
}

}  // namespace

void place_joint_rows(RowPlacement& p, int point) {
  const CorrectionSpec& spec = p.spec;
  const ActuatorLimits& limits = p.model.limits(spec.profile);
  const double soft = p.model.description().soft_limit_margin + spec.joint_margin;
  const VectorXd bound = acceleration_bound(p.model, limits, p.spec.tolerance);
  const std::vector<const CommandSample*> watched = p.watched(point);
  for (int i = 0; i < p.model.dof_count(); ++i) {
    if (!spec.locked.empty() && spec.locked[i]) continue;
    const Dof& dof = p.model.dofs()[i];
    const double lower = dof.lower + soft, upper = dof.upper - soft;
    const double fastest = limits.speed[i] * p.tolerance(FindingKind::joint_speed);
    const WatchedJoint most = watched_joint(watched, i, dof.limited, lower, upper);
    if (most.position > spec.watched_share)
      p.add(block_of(ConstraintGroup::position, point, i, 1), lower, upper);
    if (most.speed > spec.watched_share * fastest)
      p.add(block_of(ConstraintGroup::speed, point, i, 1, 1 / fastest), -spec.limit_share,
            spec.limit_share);
    if (most.acceleration > spec.watched_share * bound[i])
      p.add(block_of(ConstraintGroup::acceleration, point, i, 1, 1 / bound[i]), -spec.limit_share,
            spec.limit_share);
    // A motion that is rough already, of which the check only warns, gets no rougher.
    const double own = std::abs(watched[0]->acceleration[6 + i]);
    const double roughest = std::max(p.tolerance(FindingKind::joint_acceleration), own);
    if (most.acceleration > spec.watched_share * roughest)
      p.add(block_of(ConstraintGroup::acceleration, point, i, 1, 1 / roughest), -1, 1);
  }
}

void place_torque_rows(RowPlacement& p, int point) {
  const VectorXd most =
      p.model.limits(p.spec.profile).peak_torque * p.tolerance(FindingKind::joint_torque);
  RobotData data(p.model);
  VectorXd ratio = VectorXd::Zero(p.model.dof_count());
  for (const CommandSample* sample : p.watched(point)) {
    PointState state;
    state.motion.state = sample->state;
    state.motion.acceleration = sample->acceleration;
    const VectorXd force = inverse_dynamics(p.model, sample->state, sample->acceleration, data);
    state.wrench = force.head<6>();
    fill_motor_torques(p.model, p.points[point], force, nullptr, data, state);
    ratio = ratio.cwiseMax(state.torque.cwiseQuotient(most).cwiseAbs());
  }
  for (int i = 0; i < p.model.dof_count(); ++i) {
    if (ratio[i] <= p.spec.watched_share) continue;
    p.points[point].torques = true;
    p.add(block_of(ConstraintGroup::torque, point, i, 1, 1 / most[i]), -p.spec.limit_share,
          p.spec.limit_share);
  }
}

}  // namespace ayumi
