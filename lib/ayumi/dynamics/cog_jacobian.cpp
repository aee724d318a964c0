// Joint j has the axis s_j through p_j; a unit rate moves the links beyond it, together m_j with
// their centre of mass at c_j. With the base at rest, (6)(7), column j of the COG Jacobian is
//   (m_j / M) s_j x (c_j - p_j),  M the mass of all links, the root included.
// With the foot F at rest the base moves by (8)-(11), and (12)(13) add to the columns of the joints
// between base and foot
//   -J_F + [(p_G - p_F) x] J_wF = -s_j x (p_F - p_j) - s_j x (p_G - p_F) = -s_j x (p_G - p_j),
// which is minus the velocity of the COG as a point of the foot. The other columns stay as they
// are. For a prismatic joint, s_j replaces every product s_j x r. Written with matrices, (13) is
// J_G = J_cq - J_cb J_Fb^-1 J_Fq with the floating Jacobians of COG and foot: the tests compute
// that product for comparison.
#include "ayumi/dynamics/cog_jacobian.hpp"

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

/// The velocity and the angular velocity per unit rate of joint i, for a point p that is fixed to
/// the part that the joint moves. p is relative to the base origin.
struct PointRate {
  Vector3d linear, angular;
};
PointRate point_rate(const Body& body, const RobotData& data, size_t i, const Vector3d& p) {
  const Vector3d s = body.ratio * data.axis[i];
  if (body.prismatic) return {s, Vector3d::Zero()};
  return {s.cross(p - data.position[i]), s};
}

MatrixXd with_joints(const MatrixXd& base) {
  MatrixXd map(6 + base.cols(), base.cols());
  map.topRows<6>() = base;
  map.bottomRows(base.cols()).setIdentity();
  return map;
}

/// Adds (6)(7) to the three rows of J; joint 0 has the column `first`.
void add_held_base_columns(const RobotModel& model, RobotData& data, int first, MatrixXd& J) {
  const std::vector<Body>& bodies = model.bodies();
  // The first moment of each subtree is summed from the leaves to the root.
  for (size_t i = 0; i < bodies.size(); ++i)
    data.composite[i].moment = bodies[i].inertia.mass * data.com[i];
  const double per_mass = 1 / model.mass();
  for (size_t i = bodies.size() - 1; i > 0; --i) {
    const Body& body = bodies[i];
    const double mass = data.subtree_mass[i];
    const Vector3d& moment = data.composite[i].moment;
    const Vector3d a = body.ratio * per_mass * data.axis[i];
    Eigen::Map<Vector3d> column(J.data() + 3 * (first + body.dof));
    if (body.prismatic)
      column += mass * a;
    else
      column += a.cross(moment - mass * data.position[i]);
    data.composite[static_cast<size_t>(body.parent)].moment += moment;
  }
}

}  // namespace

void cog_jacobian(const RobotModel& model, RobotData& data, Side support, MatrixXd& J) {
  held_base_cog_jacobian(model, data, J);
  for (int i = model.sole(support).body; i > 0; i = model.bodies()[static_cast<size_t>(i)].parent) {
    const Body& body = model.bodies()[static_cast<size_t>(i)];
    Eigen::Map<Vector3d>(J.data() + 3 * body.dof) -=
        point_rate(body, data, static_cast<size_t>(i), data.cog_offset).linear;
  }
}

MatrixXd cog_jacobian(const RobotModel& model, RobotData& data, Side support) {
  MatrixXd J;
  cog_jacobian(model, data, support, J);
  return J;
}

void held_base_cog_jacobian(const RobotModel& model, RobotData& data, MatrixXd& J) {
  J.setZero(3, model.dof_count());
  add_held_base_columns(model, data, 0, J);
}

MatrixXd cog_jacobian_floating(const RobotModel& model, RobotData& data) {
  MatrixXd J = MatrixXd::Zero(3, model.velocity_count());
  J.leftCols<3>().setIdentity();
  J.block<3, 3>(0, 3) = -skew(data.cog_offset);
  add_held_base_columns(model, data, 6, J);
  return J;
}

// With the base origin as the point of reference, the base columns of J_F are inverted in closed
// form: J_Fb = [1 -[p x]; 0 1].
MatrixXd anchored_velocity_map(const RobotModel& model, const RobotData& data, Side support) {
  const int body = model.sole(support).body, n = model.dof_count();
  const Vector3d p = data.position[static_cast<size_t>(body)];
  const MatrixXd J = body_jacobian(model, data, body, data.base_position + p);
  MatrixXd base(6, n);
  base.bottomRows<3>() = -J.bottomRightCorner(3, n);
  base.topRows<3>() = -J.topRightCorner(3, n) + skew(p) * base.bottomRows<3>();
  return with_joints(base);
}

}  // namespace ayumi
