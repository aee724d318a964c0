#include "ayumi/dynamics/supports.hpp"

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

constexpr double kLength = 0.2;  // that makes a sole's turns comparable with its shifts [m]

// Velocity of the point p (from the base origin) on what joint i moves, and turn, per unit rate.
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

}  // namespace

// Normal equations of min sum over the feet |v + w x p + linear|^2 + L^2 |w + angular|^2.
MatrixXd both_feet_velocity_map(const RobotModel& model, const RobotData& data) {
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  MatrixXd b = MatrixXd::Zero(6, model.dof_count());
  for (Side side : {Side::left, Side::right}) {
    const Sole& sole = model.sole(side);
    const auto foot = static_cast<size_t>(sole.body);
    const Vector3d p = data.position[foot] + data.rotation[foot] * sole.frame.translation();
    const Matrix3d cross = skew(p);
    A.topLeftCorner<3, 3>() += Matrix3d::Identity();
    A.topRightCorner<3, 3>() -= cross;
    A.bottomLeftCorner<3, 3>() += cross;
    A.bottomRightCorner<3, 3>() += kLength * kLength * Matrix3d::Identity() - cross * cross;
    for (int i = sole.body; i > 0; i = model.bodies()[static_cast<size_t>(i)].parent) {
      const Body& body = model.bodies()[static_cast<size_t>(i)];
      const PointRate rate = point_rate(body, data, static_cast<size_t>(i), p);
      b.col(body.dof).head<3>() -= rate.linear;
      b.col(body.dof).tail<3>() -= p.cross(rate.linear) + kLength * kLength * rate.angular;
    }
  }
  return with_joints(A.llt().solve(b));
}

MatrixXd flight_velocity_map(const RobotModel& model, RobotData& data) {
  MatrixXd M;
  mass_matrix(model, data, M);
  const Eigen::Matrix<double, 6, 6> base = M.topLeftCorner<6, 6>();
  return with_joints(-base.llt().solve(M.topRightCorner(6, model.dof_count())));
}

MatrixXd both_feet_cog_jacobian(const RobotModel& model, RobotData& data) {
  return cog_jacobian_floating(model, data) * both_feet_velocity_map(model, data);
}

void held_base_cog_jacobian(const RobotModel& model, RobotData& data, MatrixXd& J) {
  const std::vector<Body>& bodies = model.bodies();
  J.setZero(3, model.dof_count());
  for (size_t i = 0; i < bodies.size(); ++i)
    data.composite[i].moment = bodies[i].inertia.mass * data.com[i];
  const double per_mass = 1 / model.mass();
  for (size_t i = bodies.size() - 1; i > 0; --i) {
    const Body& body = bodies[i];
    const double mass = data.subtree_mass[i];
    const Vector3d& moment = data.composite[i].moment;
    const Vector3d a = body.ratio * per_mass * data.axis[i];
    if (body.prismatic)
      J.col(body.dof) += mass * a;
    else
      J.col(body.dof) += a.cross(moment - mass * data.position[i]);
    data.composite[static_cast<size_t>(body.parent)].moment += moment;
  }
}

void anchored_cog_jacobian(const RobotModel& model, RobotData& data, Side support, MatrixXd& J) {
  held_base_cog_jacobian(model, data, J);
  for (int i = model.sole(support).body; i > 0; i = model.bodies()[static_cast<size_t>(i)].parent) {
    const Body& body = model.bodies()[static_cast<size_t>(i)];
    J.col(body.dof) -= point_rate(body, data, static_cast<size_t>(i), data.cog_offset).linear;
  }
}

}  // namespace ayumi
