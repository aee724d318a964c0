// Everything is written in world axes about the base origin, so parent and child share one frame
// and the tree recursions are plain sums:
//   w_i = w_p + s dq,  v_i = v_p + w_p x r,       alpha_i = alpha_p + s ddq + w_p x s dq,
//   a_i = a_p + alpha_p x r + w_p x (w_p x r),    f = m (a_c + g z),  n = I alpha + w x I w + c x
//   f, tau = s . (n_subtree - p x f_subtree).
// A prismatic joint adds s ddq + 2 w_p x s dq to a_i in place of the angular terms.
#include "ayumi/dynamics/inverse_dynamics.hpp"

#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd inverse_dynamics(const RobotModel& model, const RobotState& state,
                          const VectorXd& acceleration, RobotData& data) {
  update_velocities(model, state, data);
  VectorXd force;
  newton_euler(model, state, acceleration, data, force);
  return force;
}

void newton_euler(const RobotModel& model, const RobotState& state, const VectorXd& acceleration,
                  RobotData& data, VectorXd& force) {
  const std::vector<Body>& bodies = model.bodies();
  auto& alpha = data.angular_acceleration;
  auto& a = data.acceleration;
  a[0] = acceleration.head<3>();
  a[0].z() += kGravity;
  alpha[0] = acceleration.segment<3>(3);
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (i > 0) {
      const int p = body.parent;
      const Vector3d& w = data.angular_velocity[p];
      const Vector3d r = data.position[i] - data.position[p];
      const Vector3d rate = body.ratio * state.dtheta[body.dof] * data.axis[i];
      const Vector3d drate = body.ratio * acceleration[6 + body.dof] * data.axis[i];
      a[i] = a[p] + alpha[p].cross(r) + w.cross(w.cross(r));
      alpha[i] = alpha[p];
      if (body.prismatic)
        a[i] += drate + 2.0 * w.cross(rate);
      else
        alpha[i] += drate + w.cross(rate);
    }
    const Vector3d& w = data.angular_velocity[i];
    const Vector3d c = data.com[i] - data.position[i];
    const Matrix3d& R = data.rotation[i];
    const Vector3d w_local = R.transpose() * w;
    const Matrix3d& I = body.inertia.about_com;
    data.force[i] = body.inertia.mass * (a[i] + alpha[i].cross(c) + w.cross(w.cross(c)));
    data.moment[i] = R * (I * (R.transpose() * alpha[i]) + w_local.cross(I * w_local)) +
                     data.com[i].cross(data.force[i]);
  }
  force.setZero(model.velocity_count());
  for (size_t i = bodies.size() - 1; i > 0; --i) {
    const Body& body = bodies[i];
    const Vector3d& f = data.force[i];
    force[6 + body.dof] +=
        body.ratio *
        data.axis[i].dot(body.prismatic ? f : Vector3d(data.moment[i] - data.position[i].cross(f)));
    data.force[body.parent] += f;
    data.moment[body.parent] += data.moment[i];
  }
  force.head<3>() = data.force[0];
  force.segment<3>(3) = data.moment[0];
}

VectorXd bias_force(const RobotModel& model, const RobotState& state, RobotData& data) {
  return inverse_dynamics(model, state, VectorXd::Zero(model.velocity_count()), data);
}

namespace {

SpatialInertia body_inertia(const Body& body, const Matrix3d& R, const Vector3d& com) {
  SpatialInertia result;
  const double m = body.inertia.mass;
  result.mass = m;
  result.moment = m * com;
  result.inertia = R * body.inertia.about_com * R.transpose();
  result.inertia.diagonal().array() += m * com.squaredNorm();
  result.inertia -= m * com * com.transpose();
  // R I R^T is symmetric only up to rounding; keep the mass matrix exactly so.
  result.inertia = 0.5 * (result.inertia + result.inertia.transpose()).eval();
  return result;
}

}  // namespace

void mass_matrix(const RobotModel& model, RobotData& data, MatrixXd& M) {
  const std::vector<Body>& bodies = model.bodies();
  M.setZero(model.velocity_count(), model.velocity_count());
  for (size_t i = 0; i < bodies.size(); ++i)
    data.composite[i] = body_inertia(bodies[i], data.rotation[i], data.com[i]);
  for (size_t j = bodies.size() - 1; j > 0; --j) {
    const Body& body = bodies[j];
    const SpatialInertia& c = data.composite[j];
    // Momentum of the subtree per unit joint rate: linear p, angular h about the base origin.
    const Vector3d s = body.ratio * data.axis[j];
    const Vector3d v = body.prismatic ? s : Vector3d(data.position[j].cross(s));
    const Vector3d w = body.prismatic ? Vector3d(Vector3d::Zero()) : s;
    const Vector3d p = c.mass * v + w.cross(c.moment);
    const Vector3d h = c.inertia * w + c.moment.cross(v);
    const int column = 6 + body.dof;
    M(column, column) += v.dot(p) + w.dot(h);
    for (int i = body.parent; i > 0; i = bodies[i].parent) {
      const Vector3d si = bodies[i].ratio * data.axis[i];
      const double value = bodies[i].prismatic ? si.dot(p) : si.dot(h - data.position[i].cross(p));
      M(6 + bodies[i].dof, column) += value;
      M(column, 6 + bodies[i].dof) += value;
    }
    M.block<3, 1>(0, column) += p;
    M.block<3, 1>(3, column) += h;
    SpatialInertia& parent = data.composite[body.parent];
    parent.mass += c.mass;
    parent.moment += c.moment;
    parent.inertia += c.inertia;
  }
  M.bottomLeftCorner(model.dof_count(), 6) = M.topRightCorner(6, model.dof_count()).transpose();
  const SpatialInertia& total = data.composite[0];
  M.block<3, 3>(0, 0).diagonal().setConstant(total.mass);
  const Vector3d& c = total.moment;
  M.block<3, 3>(3, 0) << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  M.block<3, 3>(0, 3) = M.block<3, 3>(3, 0).transpose();
  M.block<3, 3>(3, 3) = total.inertia;
}

VectorXd forward_dynamics(const RobotModel& model, const RobotState& state, const VectorXd& force,
                          RobotData& data) {
  const VectorXd bias = bias_force(model, state, data);
  MatrixXd M;
  mass_matrix(model, data, M);
  return M.llt().solve(force - bias);
}

Momentum centroidal_momentum(const RobotModel& model, const RobotData& data) {
  Momentum h;
  const std::vector<Body>& bodies = model.bodies();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Vector3d& w = data.angular_velocity[i];
    const Matrix3d& R = data.rotation[i];
    const Vector3d v = data.velocity[i] + w.cross(data.com[i] - data.position[i]);
    h.linear += bodies[i].inertia.mass * v;
    h.angular += R * (bodies[i].inertia.about_com * (R.transpose() * w)) +
                 bodies[i].inertia.mass * (data.com[i] - data.cog_offset).cross(v - data.dcog);
  }
  return h;
}

Matrix3d locked_inertia(const RobotModel& model, const RobotData& data) {
  Matrix3d total = Matrix3d::Zero();
  const std::vector<Body>& bodies = model.bodies();
  for (size_t i = 0; i < bodies.size(); ++i)
    total += body_inertia(bodies[i], data.rotation[i], data.com[i] - data.cog_offset).inertia;
  return total;
}

}  // namespace ayumi
