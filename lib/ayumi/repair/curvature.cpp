#include "ayumi/repair/curvature.hpp"

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// `above` is the joint nearer to the root, or both are the same joint.
double pose_curvature(const PoseCurvature& w, const MatrixXd& J, int above, int below) {
  const Vector3d a = J.col(above).tail<3>(), b = J.col(below).tail<3>();
  return w.c.dot(a.cross(Vector3d(J.col(below).head<3>()))) + b.dot(w.K * a) -
         w.K.trace() * a.dot(b);
}

void add_pose(const RobotModel& model, Side side, const PoseCurvature& w, const MatrixXd& J,
              MatrixXd& sum) {
  std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  for (const int dof : model.leg(side)) columns.push_back(6 + dof);
  const Eigen::RowVectorXd rise = w.height.transpose() * J.topRows<3>();
  for (size_t a = 0; a < columns.size(); ++a)
    for (size_t b = a; b < columns.size(); ++b) {
      const int i = columns[a], j = columns[b];
      double both = pose_curvature(w, J, i, j);
      // The base has three rotations, which act at the same time.
      if (i >= 3 && j < 6) both = 0.5 * (both + pose_curvature(w, J, j, i));
      both += w.square * rise[i] * rise[j];
      sum(i, j) += both;
      if (i != j) sum(j, i) += both;
    }
}

// Adds the curvature of c . COG.
void add_cog(const RobotModel& model, const Vector3d& c, const PointState& state, MatrixXd& sum) {
  const MatrixXd& J = state.cog_by;
  const Matrix3d& T = state.motion.tangent;
  auto add = [&](int i, int j, double both) {
    sum(i, j) += both;
    if (i != j) sum(j, i) += both;
  };
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      const Vector3d one = T.col(a), other = T.col(b);
      add(3 + a, 3 + b,
          0.5 * c.dot(one.cross(Vector3d(J.col(3 + b))) + other.cross(Vector3d(J.col(3 + a)))));
    }
  for (int body = 1; body < static_cast<int>(model.bodies().size()); ++body) {
    const int j = 6 + model.bodies()[body].dof;
    const Vector3d moved = J.col(j);
    for (int a = 0; a < 3; ++a) add(3 + a, j, c.dot(Vector3d(T.col(a)).cross(moved)));
    for (int i = body; i > 0; i = model.bodies()[i].parent) {
      const Body& above = model.bodies()[i];
      if (above.prismatic) continue;
      add(6 + above.dof, j, above.ratio * c.dot(state.data.axis[i].cross(moved)));
    }
  }
}

// Adds the curvature of the power of the ground wrench for a rigid motion, which turns with `turn`
// and moves the base origin with `slide`.
void add_power(const RobotModel& model, const Vector3d& slide, const Vector3d& turn,
               const PointState& state, DerivativeWorkspace& workspace, Curvature& sum) {
  const Vector3d up(0, 0, kGravity);
  RobotState still = state.motion.state;
  still.base_velocity.setZero();
  still.base_angular_velocity.setZero();
  still.dtheta.setZero();
  VectorXd motion = VectorXd::Zero(model.velocity_count());
  motion << slide - up, turn, VectorXd::Zero(model.dof_count());
  InverseDynamicsDerivatives& d = workspace.force_by;
  workspace.dynamics.inverse_derivatives(still, motion, d);
  MatrixXd& G = d.configuration;
  G.leftCols<3>() += d.acceleration.leftCols<3>() * skew(turn);
  G.middleCols<3>(3) = (G.middleCols<3>(3) * state.motion.tangent).eval();
  G.middleRows<3>(3) = (state.motion.tangent.transpose() * G.middleRows<3>(3)).eval();
  motion.head<3>() = slide;
  const Vector3d spin = d.acceleration.middleRows<3>(3) * motion;
  G.block<3, 3>(3, 3) += 0.5 * skew(spin);  // both r'' and r x r''/2 turn it
  sum.acceleration += G;
  add_cog(model, model.mass() * up.cross(turn), state, sum.value);
}

// Adds the curvature of rows of the ground wrench that comes from the tangential force.
void add_cone(const WrenchRows& rows, double multiplier, const Vector6d& wrench,
              const CollocationPoint& point, const PointState& state, Curvature& sum) {
  sum.cone += rows.curvature(wrench, multiplier);
  const Eigen::Matrix<double, 2, 3> R = point.plane.frame.linear().transpose().topRows<2>();
  for (int k = 0; k < 3; ++k) sum.force_by[k] = R * state.wrench_by[k].topRows<3>();
}

}  // namespace

bool is_flat(const Curvature& curvature) { return curvature.value.size() == 0; }

Curvature curvature_of(const RobotModel& model, std::span<const RowBlock> blocks,
                       const VectorXd& multipliers, const CollocationPoint& point,
                       const PointState& state, DerivativeWorkspace& workspace) {
  std::array<PoseCurvature, 2> poses;
  std::array<bool, 2> foot = {};
  Vector6d ground = Vector6d::Zero();
  Curvature sum;
  const Vector3d base = state.motion.state.base.position;
  const Vector6d wrench = plane_wrench(point, state);
  for (const RowBlock& block : blocks) {
    const VectorXd l = multipliers.segment(block.row, block.rows());
    if (l.isZero(0)) continue;
    if (const auto* rows = std::get_if<WrenchRows>(&block.rule)) {
      ground += rows->gradient(wrench).transpose() * l;
      if (rows->curvature) add_cone(*rows, l[0], wrench, point, state, sum);
    }
    if (const auto* rows = std::get_if<SoleRows>(&block.rule)) {
      const auto s = static_cast<size_t>(rows->side);
      rows->add_curvature(state.soles[s], l, poses[s]);
      foot[s] = true;
    }
  }
  if (!foot[0] && !foot[1] && ground.isZero(0)) return sum;
  sum.value = sum.acceleration = MatrixXd::Zero(model.velocity_count(), model.velocity_count());
  for (const Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    if (foot[s]) add_pose(model, side, poses[s], state.sole_by[s], sum.value);
  }
  if (ground.isZero(0)) return sum;
  const Matrix3d R = point.plane.frame.linear();
  const Vector3d turn = R * ground.tail<3>();
  const Vector3d arm = base - point.plane.frame.translation();
  add_power(model, R * ground.head<3>() + turn.cross(arm), turn, state, workspace, sum);
  return sum;
}

}  // namespace ayumi
