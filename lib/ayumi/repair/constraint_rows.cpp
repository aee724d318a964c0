// With q' = (dp, J(r) dr, dtheta) the tangent of the configuration and D_q, D_v, D_a the base rows
// of TreeDynamics::inverse_derivatives, the ground wrench W changes by
//   value        D_q T + D_v [dw/dr] + D_a [d(dw)/dr],    T = diag(1, J(r), 1)
//   rate         D_v diag(1, dw/dr', 1) + D_a [d(dw)/dr']
//   acceleration D_a diag(1, d(dw)/dr'', 1)
// where [.] acts on the three rotation columns.
#include "ayumi/repair/constraint_rows.hpp"

#include <algorithm>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/repair/clearance_rows.hpp"
#include "ayumi/repair/command_rows.hpp"
#include "ayumi/repair/foot_rows.hpp"
#include "ayumi/repair/ground_rows.hpp"
#include "ayumi/repair/joint_rows.hpp"
#include "ayumi/repair/motor_torque.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const char* name_of(ConstraintGroup group) {
  constexpr std::array<const char*, kConstraintGroupCount> kNames = {"support",
                                                                     "normal_force",
                                                                     "friction",
                                                                     "flight",
                                                                     "zmp",
                                                                     "torsional_friction",
                                                                     "stance",
                                                                     "path",
                                                                     "swing",
                                                                     "landing",
                                                                     "foot_clearance",
                                                                     "position",
                                                                     "speed",
                                                                     "acceleration",
                                                                     "torque",
                                                                     "clearance",
                                                                     "cog",
                                                                     "pose",
                                                                     "dcm"};
  return kNames[static_cast<size_t>(group)];
}

namespace {

// Rows of inverse_dynamics by the correction's value, rate and acceleration.
std::array<MatrixXd, 3> force_derivatives(TreeDynamics& dynamics, const CorrectedMotion& m) {
  InverseDynamicsDerivatives d;
  dynamics.inverse_derivatives(m.state, m.acceleration, d);
  const MatrixXd q = d.configuration.middleCols<3>(3), v = d.velocity.middleCols<3>(3),
                 a = d.acceleration.middleCols<3>(3);
  d.configuration.middleCols<3>(3) = q * m.tangent + v * m.w_value + a * m.dw_value;
  d.velocity.middleCols<3>(3) = v * m.w_rate + a * m.dw_rate;
  d.acceleration.middleCols<3>(3) = a * m.dw_acceleration;
  return {std::move(d.configuration), std::move(d.velocity), std::move(d.acceleration)};
}

}  // namespace

ConstraintBlock block_of(ConstraintGroup group, int point, int item, int rows, double scale) {
  ConstraintBlock block;
  block.group = group;
  block.point = point;
  block.item = item;
  block.rows = rows;
  block.scale = scale;
  return block;
}

PointState point_state(const RobotModel& model, const CommandSample& sample,
                       const CollocationPoint& point, const MatrixXd& coefficients,
                       TreeDynamics* derivatives, RobotData& data) {
  PointState state;
  const auto rows = coefficients.middleRows<4>(point.weights.first);
  state.change = rows.transpose() * point.weights.value;
  state.motion = corrected_motion(sample, state.change, rows.transpose() * point.weights.rate,
                                  rows.transpose() * point.weights.acceleration);
  const CorrectedMotion& m = state.motion;
  state.data = &data;
  const VectorXd force = inverse_dynamics(model, m.state, m.acceleration, data);
  state.wrench = force.head<6>();
  std::array<MatrixXd, 3> force_by;
  if (derivatives) {
    force_by = force_derivatives(*derivatives, m);
    for (int k = 0; k < 3; ++k) state.wrench_by[k] = force_by[k].topRows<6>();
    state.cog_by = cog_jacobian_floating(model, data);
    state.cog_by.middleCols<3>(3) = (state.cog_by.middleCols<3>(3) * m.tangent).eval();
  }
  if (point.torques)
    fill_motor_torques(model, point, force, derivatives ? &force_by : nullptr, data, state);
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    state.soles[s] = sole_pose(model, data, side);
    if (!derivatives) continue;
    MatrixXd& J = state.sole_by[s];
    J = body_jacobian(model, data, model.sole(side).body, state.soles[s].translation());
    J.middleCols<3>(3) = (J.middleCols<3>(3) * m.tangent).eval();
  }
  return state;
}

std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& point) {
  if (is_of_joint_angle(block.group)) return {6 + block.item};
  if (block.group == ConstraintGroup::clearance)
    return clearance_columns(model, *point.collisions, block.shapes);
  std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  if (is_of_foot(block.group)) {
    for (int i : model.leg(static_cast<Side>(block.item))) columns.push_back(6 + i);
    std::sort(columns.begin(), columns.end());
  } else {
    for (int i = 0; i < model.dof_count(); ++i) columns.push_back(6 + i);
  }
  return columns;
}

VectorXd block_values(const RobotModel& model, const ConstraintBlock& block,
                      const CollocationPoint& point, const PointState& state) {
  if (is_of_ground(block.group)) return ground_values(block, point, state);
  if (is_of_foot(block.group)) return foot_values(model, block, point, state);
  if (is_of_joint(block.group)) return joint_values(block, state);
  if (block.group == ConstraintGroup::clearance) return clearance_values(block, point, state);
  return command_values(model, block, point, state);
}

std::array<MatrixXd, 3> block_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                          const CollocationPoint& point, const PointState& state) {
  if (is_of_ground(block.group)) return ground_derivatives(block, point, state);
  if (is_of_foot(block.group)) return {foot_derivatives(model, block, point, state), {}, {}};
  if (is_of_joint(block.group)) return joint_derivatives(model, block, state);
  if (block.group == ConstraintGroup::clearance)
    return {clearance_derivatives(model, block, point, state), {}, {}};
  return command_derivatives(model, block, point, state);
}

}  // namespace ayumi
