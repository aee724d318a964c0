// With q' = (dp, J(r) dr, dtheta) the tangent of the configuration and D_q, D_v, D_a the base rows
// of TreeDynamics::inverse_derivatives, the ground wrench W changes by
//   value        D_q T + D_v [dw/dr] + D_a [d(dw)/dr],    T = diag(1, J(r), 1)
//   rate         D_v diag(1, dw/dr', 1) + D_a [d(dw)/dr']
//   acceleration D_a diag(1, d(dw)/dr'', 1)
// where [.] acts on the three rotation columns.
//
// With P the change of reference from the base to the support plane (axes R', arm from the plane's
// origin to the base), the plane wrench is w = P W. A row g(w) has the derivatives dg/dw P dW, and
// by the base position, whose arm moves, - (dg/dw).moment skew(f).
//
// The DCM is COG + COG rate / omega. Its derivatives follow from those of the COG and of its rate:
// for a function c(x, t), d(c')/dx is half of d(c'')/dx', and m c'' is the ground force, whose
// derivative by the correction's rate is known.
#include "ayumi/repair/constraint_rows.hpp"

#include <algorithm>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/repair/motor_torque.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Converts the derivatives of inverse_dynamics() by the tangent into those by the correction.
void by_correction(const CorrectedMotion& m, InverseDynamicsDerivatives& d) {
  for (Eigen::Index i = 0; i < d.configuration.rows(); ++i) {
    const Eigen::RowVector3d q = d.configuration.block<1, 3>(i, 3),
                             v = d.velocity.block<1, 3>(i, 3), a = d.acceleration.block<1, 3>(i, 3);
    d.configuration.block<1, 3>(i, 3) = q * m.tangent + v * m.w_value + a * m.dw_value;
    d.velocity.block<1, 3>(i, 3) = v * m.w_rate + a * m.dw_rate;
    d.acceleration.block<1, 3>(i, 3) = a * m.dw_acceleration;
  }
}

void turn_by_vector(const Matrix3d& tangent, MatrixXd& by) {
  for (Eigen::Index i = 0; i < by.rows(); ++i) {
    const Eigen::RowVector3d row = by.block<1, 3>(i, 3);
    by.block<1, 3>(i, 3) = row * tangent;
  }
}

}  // namespace

void fill_values(const RobotModel& model, const ActuatorLimits& actuators,
                 const CommandSample& sample, const CollocationPoint& point,
                 const MatrixXd& coefficients, PointState& state) {
  const auto rows = coefficients.middleRows<4>(point.weights.first);
  state.change = rows.transpose() * point.weights.value;
  state.rate = rows.transpose() * point.weights.rate;
  state.second = rows.transpose() * point.weights.acceleration;
  CorrectedMotion& m = state.motion;
  fill_motion(sample, state.change, state.rate, state.second, m);
  update_velocities(model, m.state, state.data);
  newton_euler(model, m.state, m.acceleration, state.data, state.force);
  state.wrench = state.force.head<6>();
  if (point.torques) fill_motor_torques(model, actuators, point, state);
  for (Side side : {Side::left, Side::right})
    state.soles[static_cast<size_t>(side)] = sole_pose(model, state.data, side);
}

void fill_derivatives(const RobotModel& model, const ActuatorLimits& actuators,
                      const CommandSample& sample, const CollocationPoint& point,
                      DerivativeWorkspace& workspace, PointState& state) {
  CorrectedMotion& m = state.motion;
  fill_motion_derivatives(sample, state.change, state.rate, state.second, m);
  InverseDynamicsDerivatives& d = workspace.force_by;
  workspace.dynamics.inverse_derivatives(m.state, m.acceleration, d);
  by_correction(m, d);
  state.wrench_by[0] = d.configuration.topRows<6>();
  state.wrench_by[1] = d.velocity.topRows<6>();
  state.wrench_by[2] = d.acceleration.topRows<6>();
  state.cog_by = cog_jacobian_floating(model, state.data);
  turn_by_vector(m.tangent, state.cog_by);
  if (point.torques) fill_motor_torque_derivatives(model, actuators, point, d, state);
  for (Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    state.sole_by[s] =
        body_jacobian(model, state.data, model.sole(side).body, state.soles[s].translation());
    turn_by_vector(m.tangent, state.sole_by[s]);
  }
}

Vector6d plane_wrench(const CollocationPoint& point, const PointState& state) {
  return plane_wrench(point.plane, state.motion.state.base.position, state.wrench);
}

// ---- the rows for each quantity

namespace {

using Derivatives = std::array<MatrixXd, 3>;

// The columns of the base and of the joints from the root to a body.
void add_path_columns(const RobotModel& model, int body, std::vector<int>& columns) {
  for (int i = body; i > 0; i = model.bodies()[i].parent)
    columns.push_back(6 + model.bodies()[i].dof);
}

std::vector<int> all_columns(const RobotModel& model) {
  std::vector<int> columns;
  for (int i = 0; i < model.velocity_count(); ++i) columns.push_back(i);
  return columns;
}

VectorXd wrench_values(const WrenchRows& rows, const CollocationPoint& point,
                       const PointState& state) {
  return rows.value(plane_wrench(point, state));
}

Derivatives wrench_derivatives(const WrenchRows& rows, const CollocationPoint& point,
                               const PointState& state) {
  const Matrix3d R = point.plane.frame.linear().transpose();
  const Vector3d arm = state.motion.state.base.position - point.plane.frame.translation();
  Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
  P.topLeftCorner<3, 3>() = P.bottomRightCorner<3, 3>() = R;
  P.bottomLeftCorner<3, 3>() = R * skew(arm);
  const MatrixXd A = rows.gradient(plane_wrench(point, state)) * P;
  Derivatives by;
  for (int i = 0; i < 3; ++i) by[i] = A * state.wrench_by[i];
  by[0].leftCols<3>() -= A.rightCols<3>() * skew(Vector3d(state.wrench.head<3>()));
  return by;
}

struct Columns {
  const RobotModel& model;

  std::vector<int> operator()(const SoleRows& rows) const {
    std::vector<int> columns = {0, 1, 2, 3, 4, 5};
    for (int i : model.leg(rows.side)) columns.push_back(6 + i);
    std::sort(columns.begin(), columns.end());
    return columns;
  }
  std::vector<int> operator()(const JointRow& row) const {
    if (row.of == JointQuantity::motor_torque) return all_columns(model);
    return {6 + row.dof};
  }
  // The base and the joints that move both bodies in the same way are left out. What remains are
  // the paths of the two bodies.
  std::vector<int> operator()(const ClearanceRows& rows) const {
    const CollisionModel::Pair& pair = rows.collisions->pairs()[rows.shapes.pair];
    std::vector<int> columns;
    add_path_columns(model, pair.a, columns);
    add_path_columns(model, pair.b, columns);
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    return columns;
  }
  template <class Rows>
  std::vector<int> operator()(const Rows&) const {
    return all_columns(model);
  }
};

struct Values {
  const RobotModel& model;
  const CollocationPoint& point;
  const PointState& state;

  VectorXd operator()(const WrenchRows& rows) const { return wrench_values(rows, point, state); }
  VectorXd operator()(const SoleRows& rows) const {
    return rows.value(state.soles[static_cast<int>(rows.side)]);
  }
  VectorXd operator()(const JointRow& row) const {
    return VectorXd::Constant(1, row.scale * quantity(row));
  }
  VectorXd operator()(const ClearanceRows& rows) const {
    const std::vector<Closest> points = clearance_points(*rows.collisions, rows.shapes, state.data);
    VectorXd values(static_cast<Eigen::Index>(points.size()));
    for (size_t i = 0; i < points.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = points[i].clearance;
    return values;
  }
  VectorXd operator()(const CogRows& rows) const { return state.data.cog - rows.from; }
  VectorXd operator()(const CorrectionRows&) const { return state.change; }
  VectorXd operator()(const DcmRows& rows) const {
    const Vector3d dcm = state.data.cog + rows.time * state.data.dcog;
    VectorXd values(4);
    values << dcm.head<2>() - rows.from, wrench_values(rows.zmp, point, state);
    return values;
  }

  double quantity(const JointRow& row) const {
    const RobotState& motion = state.motion.state;
    switch (row.of) {
      case JointQuantity::angle:
        return motion.theta[row.dof] + row.lead * motion.dtheta[row.dof];
      case JointQuantity::speed:
        return motion.dtheta[row.dof] + row.lead * state.motion.acceleration[6 + row.dof];
      case JointQuantity::acceleration:
        return state.motion.acceleration[6 + row.dof];
      default:
        return state.torque[row.dof];
    }
  }
};

struct ByCorrection {
  const RobotModel& model;
  const CollocationPoint& point;
  const PointState& state;

  Derivatives operator()(const WrenchRows& rows) const {
    return wrench_derivatives(rows, point, state);
  }
  Derivatives operator()(const SoleRows& rows) const {
    const auto s = static_cast<size_t>(rows.side);
    return {rows.rate(state.soles[s], state.sole_by[s]), {}, {}};
  }
  Derivatives operator()(const JointRow& row) const {
    Derivatives by;
    if (row.of == JointQuantity::motor_torque) {
      for (int k = 0; k < 3; ++k) by[k] = row.scale * state.torque_by[k].row(row.dof);
      return by;
    }
    const auto order = static_cast<size_t>(row.of);
    const auto set = [&](size_t of, double factor) {
      by[of] = MatrixXd::Zero(1, model.velocity_count());
      by[of](0, 6 + row.dof) = factor;
    };
    set(order, row.scale);
    if (row.lead > 0) set(order + 1, row.scale * row.lead);
    return by;
  }
  Derivatives operator()(const ClearanceRows& rows) const {
    MatrixXd by = clearance_gradient(model, *rows.collisions, rows.shapes, state.data);
    turn_by_vector(state.motion.tangent, by);
    return {std::move(by), {}, {}};
  }
  Derivatives operator()(const CogRows&) const { return {state.cog_by, {}, {}}; }
  Derivatives operator()(const CorrectionRows&) const {
    return {MatrixXd::Identity(model.velocity_count(), model.velocity_count()), {}, {}};
  }
  Derivatives operator()(const DcmRows& rows) const {
    const Derivatives zmp = wrench_derivatives(rows.zmp, point, state);
    const MatrixXd cog = state.cog_by.topRows<2>();
    const MatrixXd rate = 0.5 / model.mass() * state.wrench_by[1].topRows<2>();
    const MatrixXd dcm[] = {cog + rows.time * rate, rows.time * cog, 0 * cog};
    Derivatives by;
    for (int k = 0; k < 3; ++k) {
      by[k].resize(4, cog.cols());
      by[k] << dcm[k], zmp[k];
    }
    return by;
  }
};

}  // namespace

std::vector<int> block_columns(const RobotModel& model, const RowBlock& block) {
  return std::visit(Columns{model}, block.rule);
}

VectorXd block_values(const RobotModel& model, const RowBlock& block, const CollocationPoint& point,
                      const PointState& state) {
  return std::visit(Values{model, point, state}, block.rule);
}

std::array<MatrixXd, 3> block_derivatives(const RobotModel& model, const RowBlock& block,
                                          const CollocationPoint& point, const PointState& state) {
  return std::visit(ByCorrection{model, point, state}, block.rule);
}

}  // namespace ayumi
