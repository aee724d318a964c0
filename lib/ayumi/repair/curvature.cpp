#include "ayumi/repair/curvature.hpp"

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/repair/foot_rows.hpp"
#include "ayumi/repair/ground_rows.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Weights on the pose of a sole: c on its position, K on its rotation. Two turns, one about a and
// one about b nearer to the root, add  a' K b - tr(K) a . b  to the sum.
struct PoseWeights {
  Vector3d c = Vector3d::Zero();
  Matrix3d K = Matrix3d::Zero();
  Vector3d height = Vector3d::Zero();  // direction in which the squared height counts
  double square = 0;                   // weight of that square
};

// Weight K of a rotation error  d . vee(E - E')/2,  E = R R_planned'.
Matrix3d turning(const Vector3d& d, const Isometry3d& sole, const Isometry3d& planned) {
  return 0.5 * skew(d) * planned.linear() * sole.linear().transpose();
}

void add_landing(const RobotModel& model, const ConstraintBlock& block, const VectorXd& l,
                 const Isometry3d& sole, const Isometry3d& place, PoseWeights& sum) {
  const Vector3d normal = place.linear().col(2);
  const double height = normal.dot(sole.translation() - place.translation());
  const Vector6d offset = landing_rows(model, static_cast<Side>(block.item), place).transpose() *
                          (l.tail<5>() - l.head<5>());
  sum.c += offset.head<3>() + 2 * block.factor * l.sum() * height * normal;
  sum.K += turning(offset.tail<3>(), sole, place);
  sum.height = normal;
  sum.square += 2 * block.factor * l.sum();
}

void add_foot(const RobotModel& model, const ConstraintBlock& block, const VectorXd& l,
              const CollocationPoint& point, const PointState& state, PoseWeights& sum) {
  const Isometry3d &sole = state.soles[block.item], &ground = point.ground[block.item];
  if (block.group == ConstraintGroup::landing) {
    add_landing(model, block, l, sole, point.place[block.item], sum);
  } else if (block.group == ConstraintGroup::stance || block.group == ConstraintGroup::path) {
    const bool path = block.group == ConstraintGroup::path;
    sum.c += l.head<3>();
    sum.K += turning(l.tail<3>(), sole, path ? point.path[block.item] : ground);
  } else {
    const Vector3d normal = ground.linear().col(2);
    const auto& corners = model.sole(static_cast<Side>(block.item)).polygon;
    Vector3d arms = Vector3d::Zero();
    for (int i = 0; i < block.rows; ++i) {
      const Eigen::Vector2d& v = corners[static_cast<size_t>(i)];
      arms += l[i] * (sole.linear() * Vector3d(v.x(), v.y(), 0));
    }
    sum.c += l.sum() * normal;
    sum.K += normal * arms.transpose();
  }
}

// `above` is nearer to the root than `below`, or the same.
double pose_curvature(const PoseWeights& w, const MatrixXd& J, int above, int below) {
  const Vector3d a = J.col(above).tail<3>(), b = J.col(below).tail<3>();
  return w.c.dot(a.cross(Vector3d(J.col(below).head<3>()))) + b.dot(w.K * a) -
         w.K.trace() * a.dot(b);
}

void add_pose(const RobotModel& model, Side side, const PoseWeights& w, const MatrixXd& J,
              MatrixXd& sum) {
  std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  for (const int dof : model.leg(side)) columns.push_back(6 + dof);
  const Eigen::RowVectorXd rise = w.height.transpose() * J.topRows<3>();
  for (size_t a = 0; a < columns.size(); ++a)
    for (size_t b = a; b < columns.size(); ++b) {
      const int i = columns[a], j = columns[b];
      double both = pose_curvature(w, J, i, j);
      if (i >= 3 && j < 6) both = 0.5 * (both + pose_curvature(w, J, j, i));  // three turns at once
      both += w.square * rise[i] * rise[j];
      sum(i, j) += both;
      if (i != j) sum(j, i) += both;
    }
}

// Adds the curvature of  c . COG.
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
      add(6 + above.dof, j, above.ratio * c.dot(state.data->axis[i].cross(moved)));
    }
  }
}

// Adds the curvature of the ground wrench's power on the rigid motion that turns with `turn` and
// moves the base origin with `slide`.
void add_power(const RobotModel& model, const Vector3d& slide, const Vector3d& turn,
               const PointState& state, TreeDynamics& dynamics, Curvature& sum) {
  const Vector3d up(0, 0, kGravity);
  RobotState still = state.motion.state;
  still.base_velocity.setZero();
  still.base_angular_velocity.setZero();
  still.dtheta.setZero();
  VectorXd motion = VectorXd::Zero(model.velocity_count());
  motion << slide - up, turn, VectorXd::Zero(model.dof_count());
  InverseDynamicsDerivatives d;
  dynamics.inverse_derivatives(still, motion, d);
  MatrixXd& G = d.configuration;
  G.leftCols<3>() += d.acceleration.leftCols<3>() * skew(turn);
  G.middleCols<3>(3) = (G.middleCols<3>(3) * state.motion.tangent).eval();
  G.middleRows<3>(3) = (state.motion.tangent.transpose() * G.middleRows<3>(3)).eval();
  motion.head<3>() = slide;
  const Vector3d spin = d.acceleration.middleRows<3>(3) * motion;
  G.block<3, 3>(3, 3) += 0.5 * skew(spin);  // r'' and r x r''/2 both turn
  sum.acceleration += G;
  add_cog(model, model.mass() * up.cross(turn), state, sum.value);
}

void add_cone(const ConstraintBlock& block, double multiplier, const Vector6d& wrench,
              const CollocationPoint& point, const PointState& state, Curvature& sum) {
  const Eigen::Vector2d pull = wrench.head<2>();
  const double size = rounded_tangential_force(block, wrench);
  sum.cone -= multiplier * block.scale / size *
              (Eigen::Matrix2d::Identity() - pull * pull.transpose() / (size * size));
  const Eigen::Matrix<double, 2, 3> R = point.plane.frame.linear().transpose().topRows<2>();
  for (int k = 0; k < 3; ++k) sum.force_by[k] = R * state.wrench_by[k].topRows<3>();
}

}  // namespace

bool is_flat(const Curvature& curvature) { return curvature.value.size() == 0; }

Curvature curvature_of(const RobotModel& model, std::span<const ConstraintBlock> blocks,
                       const VectorXd& multipliers, const CollocationPoint& point,
                       const PointState& state, TreeDynamics& dynamics) {
  std::array<PoseWeights, 2> poses;
  std::array<bool, 2> foot = {};
  Vector6d ground = Vector6d::Zero();
  Curvature sum;
  const Vector3d base = state.motion.state.base.position;
  const Vector6d wrench = plane_wrench(point.plane, base, state.wrench);
  for (const ConstraintBlock& block : blocks) {
    const VectorXd l = multipliers.segment(block.row, block.rows);
    if (l.isZero(0)) continue;
    if (is_of_ground(block.group)) ground += ground_gradient(block, wrench).transpose() * l;
    if (block.group == ConstraintGroup::friction) add_cone(block, l[0], wrench, point, state, sum);
    if (!is_of_foot(block.group)) continue;
    add_foot(model, block, l, point, state, poses[block.item]);
    foot[block.item] = true;
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
  add_power(model, R * ground.head<3>() + turn.cross(arm), turn, state, dynamics, sum);
  return sum;
}

}  // namespace ayumi
