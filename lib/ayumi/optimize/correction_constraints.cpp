// With q' = (dp, J(r) dr, dtheta) the tangent of the configuration and D_q, D_v, D_a the base rows
// of inverse_dynamics_derivatives, the ground wrench W changes by
//   value        D_q T + D_v [dw/dr] + D_a [d(dw)/dr],    T = diag(1, J(r), 1)
//   rate         D_v diag(1, dw/dr', 1) + D_a [d(dw)/dr']
//   acceleration D_a diag(1, d(dw)/dr'', 1)
// [.] acting on the three rotation columns. Rotation error of a sole: e = vee(E - E')/2,
// E = R R_planned', de = (tr(E) 1 - E) w / 2.
#include "ayumi/optimize/correction_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

const char* name_of(ConstraintGroup group) {
  constexpr const char* kNames[] = {"support", "unilateral", "friction", "flight", "yaw",
                                    "stance",  "swing",      "position", "speed"};
  return kNames[static_cast<int>(group)];
}

namespace {

void wrench_derivatives(const RobotModel& model, RobotData& data, InstantState& state) {
  const CorrectedMotion& m = state.motion;
  InverseDynamicsDerivatives d;
  inverse_dynamics_derivatives(model, m.state, m.acceleration, data, d);
  const MatrixXd Dq = d.configuration.topRows<6>(), Dv = d.velocity.topRows<6>(),
                 Da = d.acceleration.topRows<6>();
  const auto v = Dv.middleCols<3>(3), a = Da.middleCols<3>(3);
  state.wrench_by = {Dq, Dv, Da};
  state.wrench_by[0].middleCols<3>(3) =
      Dq.middleCols<3>(3) * m.tangent + v * m.w_value + a * m.dw_value;
  state.wrench_by[1].middleCols<3>(3) = v * m.w_rate + a * m.dw_rate;
  state.wrench_by[2].middleCols<3>(3) = a * m.dw_acceleration;
}

Matrix3d rotation_error(const Isometry3d& actual, const Isometry3d& planned) {
  return actual.linear() * planned.linear().transpose();
}

std::vector<Vector3d> corners(const RobotModel& model, Side side, const Isometry3d& sole) {
  std::vector<Vector3d> result;
  for (const Eigen::Vector2d& v : model.sole(side).polygon)
    result.push_back(sole * Vector3d(v.x(), v.y(), 0));
  return result;
}

bool of_ground(ConstraintGroup group) { return group <= ConstraintGroup::yaw; }

// Yaw moment about the ZMP of a plane wrench (f, n): n_z + (n_x f_x + n_y f_y) / f_z.
double yaw_moment(const Vector6d& w) { return w[5] + (w[3] * w[0] + w[4] * w[1]) / w[2]; }

Eigen::Matrix<double, 1, 6> yaw_gradient(const Vector6d& w) {
  Eigen::Matrix<double, 1, 6> g;
  g << w[3], w[4], -(w[3] * w[0] + w[4] * w[1]) / w[2], w[0], w[1], w[2];
  return g / w[2];
}

// A ground block by the plane wrench, and its derivative.
VectorXd ground_values(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group != ConstraintGroup::yaw) return block.wrench_rows * w;
  const double most = block.factor * w[2], moment = yaw_moment(w);
  return block.scale * Eigen::Vector2d(most - moment, most + moment);
}

MatrixXd ground_gradient(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group != ConstraintGroup::yaw) return block.wrench_rows;
  MatrixXd rows(2, 6);
  rows << -yaw_gradient(w), yaw_gradient(w);
  rows.col(2).array() += block.factor;
  return block.scale * rows;
}

}  // namespace

InstantState instant_state(const RobotModel& model, const CommandSample& sample,
                           const Instant& instant, const MatrixXd& coefficients, bool derivatives,
                           RobotData& data) {
  InstantState state;
  const auto rows = coefficients.middleRows<4>(instant.weights.first);
  state.motion = corrected_motion(sample, rows.transpose() * instant.weights.value,
                                  rows.transpose() * instant.weights.rate,
                                  rows.transpose() * instant.weights.acceleration);
  const CorrectedMotion& m = state.motion;
  state.wrench = inverse_dynamics(model, m.state, m.acceleration, data).head<6>();
  if (derivatives) wrench_derivatives(model, data, state);
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

std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block) {
  std::vector<int> columns;
  if (block.group == ConstraintGroup::position || block.group == ConstraintGroup::speed)
    return {6 + block.item};
  for (int i = 0; i < 6; ++i) columns.push_back(i);
  if (of_ground(block.group)) {
    for (int i = 0; i < model.dof_count(); ++i) columns.push_back(6 + i);
  } else {
    for (int i : model.leg(static_cast<Side>(block.item))) columns.push_back(6 + i);
    std::sort(columns.begin(), columns.end());
  }
  return columns;
}

VectorXd block_values(const RobotModel& model, const ConstraintBlock& block, const Instant& instant,
                      const InstantState& state) {
  const RobotState& robot = state.motion.state;
  if (of_ground(block.group))
    return ground_values(block, plane_wrench(instant.plane, robot.base.position, state.wrench));
  if (block.group == ConstraintGroup::position)
    return VectorXd::Constant(1, robot.theta[block.item]);
  if (block.group == ConstraintGroup::speed)
    return VectorXd::Constant(1, block.scale * robot.dtheta[block.item]);
  const Isometry3d &sole = state.soles[block.item], &ground = instant.ground[block.item];
  VectorXd values(block.rows);
  if (block.group == ConstraintGroup::stance) {
    const Matrix3d E = rotation_error(sole, ground);
    values << sole.translation() - ground.translation(),
        0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  } else {
    const Vector3d normal = ground.linear().col(2);
    const auto points = corners(model, static_cast<Side>(block.item), sole);
    for (int i = 0; i < block.rows; ++i) values[i] = normal.dot(points[i] - ground.translation());
  }
  return values;
}

std::array<MatrixXd, 3> block_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                          const Instant& instant, const InstantState& state) {
  std::array<MatrixXd, 3> by;
  const int n = model.velocity_count();
  if (of_ground(block.group)) {
    const Matrix3d R = instant.plane.frame.linear().transpose();
    const Vector3d arm = state.motion.state.base.position - instant.plane.frame.translation();
    Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
    P.topLeftCorner<3, 3>() = P.bottomRightCorner<3, 3>() = R;
    P.bottomLeftCorner<3, 3>() = R * skew(arm);
    const Vector6d w = plane_wrench(instant.plane, state.motion.state.base.position, state.wrench);
    const MatrixXd A = ground_gradient(block, w) * P;
    for (int i = 0; i < 3; ++i) by[i] = A * state.wrench_by[i];
    const Vector3d f = state.wrench.head<3>();
    by[0].leftCols<3>() -= A.rightCols<3>() * skew(f);
    return by;
  }
  if (block.group == ConstraintGroup::position) {
    by[0] = MatrixXd::Zero(1, n);
    by[0](0, 6 + block.item) = 1;
    return by;
  }
  if (block.group == ConstraintGroup::speed) {
    by[1] = MatrixXd::Zero(1, n);
    by[1](0, 6 + block.item) = block.scale;
    return by;
  }
  const Isometry3d &sole = state.soles[block.item], &ground = instant.ground[block.item];
  const MatrixXd& J = state.sole_by[block.item];
  by[0].resize(block.rows, n);
  if (block.group == ConstraintGroup::stance) {
    const Matrix3d E = rotation_error(sole, ground);
    by[0].topRows<3>() = J.topRows<3>();
    by[0].bottomRows<3>() = 0.5 * (E.trace() * Matrix3d::Identity() - E) * J.bottomRows<3>();
  } else {
    const Vector3d normal = ground.linear().col(2);
    const auto points = corners(model, static_cast<Side>(block.item), sole);
    for (int i = 0; i < block.rows; ++i) {
      const Vector3d arm = points[i] - sole.translation();
      by[0].row(i) =
          normal.transpose() * J.topRows<3>() + arm.cross(normal).transpose() * J.bottomRows<3>();
    }
  }
  return by;
}

}  // namespace ayumi
