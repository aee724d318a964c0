#include "ayumi/dynamics/inverse_dynamics.hpp"

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
  force.resize(model.velocity_count());
  const kernels::Job job = {
      .dtheta = state.dtheta.data(), .input = acceleration.data(), .output = force.data()};
  data.kernels->newton_euler(data.tree(), job, data.bodies());
}

VectorXd bias_force(const RobotModel& model, const RobotState& state, RobotData& data) {
  return inverse_dynamics(model, state, VectorXd::Zero(model.velocity_count()), data);
}

void mass_matrix(const RobotModel& model, RobotData& data, MatrixXd& M) {
  M.setZero(model.velocity_count(), model.velocity_count());
  data.kernels->mass_entries(data.tree(), data.bodies(),
                             {data.column_begin.data(), data.column.data(), data.rank.data(), true},
                             M.data());
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

}  // namespace ayumi
