// With q' = (dp, J(r) dr, dtheta) the tangent of the configuration and D_q, D_v, D_a the base rows
// of TreeDynamics::inverse_derivatives, the ground wrench W changes by
//   value        D_q T + D_v [dw/dr] + D_a [d(dw)/dr],    T = diag(1, J(r), 1)
//   rate         D_v diag(1, dw/dr', 1) + D_a [d(dw)/dr']
//   acceleration D_a diag(1, d(dw)/dr'', 1)
// [.] acting on the three rotation columns. Rotation error of a sole: e = vee(E - E')/2,
// E = R R_planned', de = (tr(E) 1 - E) w / 2. COG rate: of a function c(x, t) d(c')/dx is half of
// d(c'')/dx', and that is the ground force by the rate, over the mass.
#include "ayumi/repair/correction_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/repair/motor_torque.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

const char* name_of(ConstraintGroup group) {
  constexpr const char* kNames[] = {
      "support", "unilateral", "friction", "flight",         "zmp",      "yaw",   "stance",
      "path",    "swing",      "landing",  "foot_clearance", "position", "speed", "acceleration",
      "torque",  "clearance",  "cog",      "pose",           "capture"};
  return kNames[static_cast<int>(group)];
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

Matrix3d rotation_error(const Isometry3d& actual, const Isometry3d& planned) {
  return actual.linear() * planned.linear().transpose();
}

std::vector<Vector3d> corners(const RobotModel& model, Side side, const Isometry3d& sole) {
  std::vector<Vector3d> result;
  for (const Eigen::Vector2d& v : model.sole(side).polygon)
    result.push_back(sole * Vector3d(v.x(), v.y(), 0));
  return result;
}

// Yaw moment about the ZMP of a plane wrench (f, n): n_z + (n_x f_x + n_y f_y) / f_z.
double yaw_moment(const Vector6d& w) { return w[5] + (w[3] * w[0] + w[4] * w[1]) / w[2]; }

Eigen::Matrix<double, 1, 6> yaw_gradient(const Vector6d& w) {
  Eigen::Matrix<double, 1, 6> g;
  g << w[3], w[4], -(w[3] * w[0] + w[4] * w[1]) / w[2], w[0], w[1], w[2];
  return g / w[2];
}

// A ground block by the plane wrench, and its derivative.
VectorXd ground_values(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group == ConstraintGroup::friction)
    return VectorXd::Constant(1, block.scale * (block.factor * w[2] - cone_size(block, w)));
  if (block.group != ConstraintGroup::yaw) return block.wrench_rows * w;
  const double most = block.factor * w[2], moment = yaw_moment(w);
  return block.scale * Eigen::Vector2d(most - moment, most + moment);
}

}  // namespace

bool is_of_ground(ConstraintGroup group) { return group <= ConstraintGroup::yaw; }

double cone_size(const ConstraintBlock& block, const Vector6d& w) {
  constexpr double kRound = 1e-4;
  return std::sqrt(w.head<2>().squaredNorm() + std::pow(kRound / block.scale, 2));
}

MatrixXd ground_gradient(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group == ConstraintGroup::friction) {
    MatrixXd row = MatrixXd::Zero(1, 6);
    row.leftCols<2>() = -w.head<2>().transpose() / cone_size(block, w);
    row(0, 2) = block.factor;
    return block.scale * row;
  }
  if (block.group != ConstraintGroup::yaw) return block.wrench_rows;
  MatrixXd rows(2, 6);
  rows << -yaw_gradient(w), yaw_gradient(w);
  rows.col(2).array() += block.factor;
  return block.scale * rows;
}

Vector6d sole_deviation(const Isometry3d& actual, const Isometry3d& planned) {
  const Matrix3d E = rotation_error(actual, planned);
  Vector6d deviation;
  deviation << actual.translation() - planned.translation(),
      0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  return deviation;
}

Eigen::Matrix<double, 5, 6> landing_rows(const RobotModel& model, Side side,
                                         const Isometry3d& place) {
  double reach = 0;
  for (const Eigen::Vector2d& v : model.sole(side).polygon) reach = std::max(reach, v.norm());
  Eigen::Matrix<double, 5, 6> rows = Eigen::Matrix<double, 5, 6>::Zero();
  rows.topLeftCorner<2, 3>() = place.linear().leftCols<2>().transpose();
  rows.bottomRightCorner<3, 3>() = reach * place.linear().transpose();
  return rows;
}

PointState point_state(const RobotModel& model, const CommandSample& sample,
                       const CollocationPoint& instant, const MatrixXd& coefficients,
                       TreeDynamics* derivatives, RobotData& data) {
  PointState state;
  const auto rows = coefficients.middleRows<4>(instant.weights.first);
  state.change = rows.transpose() * instant.weights.value;
  state.motion = corrected_motion(sample, state.change, rows.transpose() * instant.weights.rate,
                                  rows.transpose() * instant.weights.acceleration);
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
  if (instant.torques)
    fill_motor_torques(model, instant, force, derivatives ? &force_by : nullptr, data, state);
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

namespace {

bool of_heights(ConstraintGroup group) {
  return group == ConstraintGroup::swing || group == ConstraintGroup::foot_clearance;
}

bool of_foot(ConstraintGroup group) {
  return group >= ConstraintGroup::stance && group <= ConstraintGroup::foot_clearance;
}

// Where the block's joint moves alone: value, rate or acceleration of its own column.
int order_of(ConstraintGroup group) {
  return group == ConstraintGroup::position ? 0 : group == ConstraintGroup::speed ? 1 : 2;
}

bool of_joint(ConstraintGroup group) {
  return group >= ConstraintGroup::position && group <= ConstraintGroup::acceleration;
}

const Isometry3d& reference(const ConstraintBlock& block, const CollocationPoint& instant) {
  return block.group == ConstraintGroup::path ? instant.path[block.item]
                                              : instant.ground[block.item];
}

VectorXd foot_values(const RobotModel& model, const ConstraintBlock& block,
                     const CollocationPoint& instant, const PointState& state) {
  const Isometry3d &sole = state.soles[block.item], &ground = reference(block, instant);
  VectorXd values(block.rows);
  if (block.group == ConstraintGroup::landing) {
    const Isometry3d& place = instant.place[block.item];
    const auto way = landing_way(model, static_cast<Side>(block.item), sole, place);
    const double height = place.linear().col(2).dot(sole.translation() - place.translation());
    values << way, -way;
    return (block.factor * height * height - values.array()).matrix();
  }
  if (!of_heights(block.group)) return sole_deviation(sole, ground);
  const Vector3d normal = ground.linear().col(2);
  const auto points = corners(model, static_cast<Side>(block.item), sole);
  for (int i = 0; i < block.rows; ++i) values[i] = normal.dot(points[i] - ground.translation());
  return values;
}

// Of sole_deviation(), by what moves the sole as J.
MatrixXd deviation_by(const Isometry3d& sole, const Isometry3d& planned, const MatrixXd& J) {
  const Matrix3d E = rotation_error(sole, planned);
  MatrixXd by(6, J.cols());
  by << J.topRows<3>(), 0.5 * (E.trace() * Matrix3d::Identity() - E) * J.bottomRows<3>();
  return by;
}

MatrixXd foot_derivatives(const RobotModel& model, const ConstraintBlock& block,
                          const CollocationPoint& instant, const PointState& state) {
  const Isometry3d &sole = state.soles[block.item], &ground = reference(block, instant);
  const MatrixXd& J = state.sole_by[block.item];
  MatrixXd by(block.rows, model.velocity_count());
  if (block.group == ConstraintGroup::landing) {
    const Isometry3d& place = instant.place[block.item];
    const Vector3d normal = place.linear().col(2);
    const double height = normal.dot(sole.translation() - place.translation());
    const MatrixXd way =
        landing_rows(model, static_cast<Side>(block.item), place) * deviation_by(sole, place, J);
    by << -way, way;
    by.rowwise() += 2 * block.factor * height * normal.transpose() * J.topRows<3>();
    return by;
  }
  if (!of_heights(block.group)) return deviation_by(sole, ground, J);
  const Vector3d normal = ground.linear().col(2);
  const auto points = corners(model, static_cast<Side>(block.item), sole);
  for (int i = 0; i < block.rows; ++i) {
    const Vector3d arm = points[i] - sole.translation();
    by.row(i) =
        normal.transpose() * J.topRows<3>() + arm.cross(normal).transpose() * J.bottomRows<3>();
  }
  return by;
}

MatrixXd clearance_derivatives(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& instant, const PointState& state) {
  MatrixXd by = clearance_gradient(model, *instant.collisions, block.shapes, *state.data);
  by.middleCols<3>(3) = (by.middleCols<3>(3) * state.motion.tangent).eval();
  return by;
}

VectorXd clearance_values(const ConstraintBlock& block, const CollocationPoint& instant,
                          const PointState& state) {
  const auto points = clearance_points(*instant.collisions, block.shapes, *state.data);
  VectorXd values(block.rows);
  for (int i = 0; i < block.rows; ++i) values[i] = points[static_cast<size_t>(i)].clearance;
  return values;
}

std::array<MatrixXd, 3> ground_derivatives(const ConstraintBlock& block,
                                           const CollocationPoint& instant,
                                           const PointState& state) {
  const Matrix3d R = instant.plane.frame.linear().transpose();
  const Vector3d base = state.motion.state.base.position;
  const Vector3d arm = base - instant.plane.frame.translation();
  Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
  P.topLeftCorner<3, 3>() = P.bottomRightCorner<3, 3>() = R;
  P.bottomLeftCorner<3, 3>() = R * skew(arm);
  const MatrixXd A = ground_gradient(block, plane_wrench(instant.plane, base, state.wrench)) * P;
  std::array<MatrixXd, 3> by;
  for (int i = 0; i < 3; ++i) by[i] = A * state.wrench_by[i];
  by[0].leftCols<3>() -= A.rightCols<3>() * skew(Vector3d(state.wrench.head<3>()));
  return by;
}

VectorXd capture_values(const RobotModel& model, const ConstraintBlock& block,
                        const CollocationPoint& instant, const PointState& state) {
  const CorrectedMotion& m = state.motion;
  const Vector3d rate = cog_jacobian_floating(model, *state.data) * m.state.velocity();
  const Vector3d xi = state.data->cog + block.factor * rate;
  const Vector6d w = plane_wrench(instant.plane, m.state.base.position, state.wrench);
  VectorXd values(4);
  values << xi.head<2>() - instant.xi, ground_values(block, w);
  return values;
}

std::array<MatrixXd, 3> capture_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                            const CollocationPoint& instant,
                                            const PointState& state) {
  const auto zmp = ground_derivatives(block, instant, state);
  const MatrixXd cog = state.cog_by.topRows<2>();
  const MatrixXd rate = 0.5 / model.mass() * state.wrench_by[1].topRows<2>();
  const MatrixXd xi[] = {cog + block.factor * rate, block.factor * cog, 0 * cog};
  std::array<MatrixXd, 3> by;
  for (int k = 0; k < 3; ++k) {
    by[k].resize(4, cog.cols());
    by[k] << xi[k], zmp[k];
  }
  return by;
}

void add_path(const RobotModel& model, int body, std::vector<int>& columns) {
  for (int i = body; i > 0; i = model.bodies()[i].parent)
    columns.push_back(6 + model.bodies()[i].dof);
}

}  // namespace

Eigen::Matrix<double, 5, 1> landing_way(const RobotModel& model, Side side,
                                        const Isometry3d& actual, const Isometry3d& place) {
  return landing_rows(model, side, place) * sole_deviation(actual, place);
}

ConstraintBlock block_of(ConstraintGroup group, int instant, int item, int rows, double scale) {
  ConstraintBlock block;
  block.group = group;
  block.instant = instant;
  block.item = item;
  block.rows = rows;
  block.scale = scale;
  return block;
}

std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& instant) {
  if (of_joint(block.group)) return {6 + block.item};
  std::vector<int> columns;
  if (block.group == ConstraintGroup::clearance) {
    const CollisionModel::Pair& pair = instant.collisions->pairs()[block.item];
    add_path(model, pair.a, columns);
    add_path(model, pair.b, columns);
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    return columns;
  }
  for (int i = 0; i < 6; ++i) columns.push_back(i);
  if (of_foot(block.group)) {
    for (int i : model.leg(static_cast<Side>(block.item))) columns.push_back(6 + i);
    std::sort(columns.begin(), columns.end());
  } else {
    for (int i = 0; i < model.dof_count(); ++i) columns.push_back(6 + i);
  }
  return columns;
}

VectorXd block_values(const RobotModel& model, const ConstraintBlock& block,
                      const CollocationPoint& instant, const PointState& state) {
  const CorrectedMotion& m = state.motion;
  if (is_of_ground(block.group))
    return ground_values(block, plane_wrench(instant.plane, m.state.base.position, state.wrench));
  if (of_foot(block.group)) return foot_values(model, block, instant, state);
  switch (block.group) {
    case ConstraintGroup::position:
      return VectorXd::Constant(1, m.state.theta[block.item]);
    case ConstraintGroup::speed:
      return VectorXd::Constant(1, block.scale * m.state.dtheta[block.item]);
    case ConstraintGroup::acceleration:
      return VectorXd::Constant(1, block.scale * m.acceleration[6 + block.item]);
    case ConstraintGroup::torque:
      return VectorXd::Constant(1, block.scale * state.torque[block.item]);
    case ConstraintGroup::clearance:
      return clearance_values(block, instant, state);
    case ConstraintGroup::pose:
      return state.change;
    case ConstraintGroup::capture:
      return capture_values(model, block, instant, state);
    default:
      return state.data->cog - instant.cog;
  }
}

std::array<MatrixXd, 3> block_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                          const CollocationPoint& instant,
                                          const PointState& state) {
  std::array<MatrixXd, 3> by;
  if (is_of_ground(block.group)) return ground_derivatives(block, instant, state);
  if (of_foot(block.group)) {
    by[0] = foot_derivatives(model, block, instant, state);
  } else if (of_joint(block.group)) {
    MatrixXd& own = by[order_of(block.group)];
    own = MatrixXd::Zero(1, model.velocity_count());
    own(0, 6 + block.item) = block.scale;
  } else if (block.group == ConstraintGroup::torque) {
    for (int k = 0; k < 3; ++k) by[k] = block.scale * state.torque_by[k].row(block.item);
  } else if (block.group == ConstraintGroup::clearance) {
    by[0] = clearance_derivatives(model, block, instant, state);
  } else if (block.group == ConstraintGroup::pose) {
    by[0].setIdentity(block.rows, model.velocity_count());
  } else if (block.group == ConstraintGroup::capture) {
    by = capture_derivatives(model, block, instant, state);
  } else {
    by[0] = state.cog_by;
  }
  return by;
}

}  // namespace ayumi
