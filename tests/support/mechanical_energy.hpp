#pragma once

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi::test {

/// Kinetic energy, including that of the rotors, and potential energy above z = 0 [J].
inline double mechanical_energy(const RobotModel& model, const RobotState& state) {
  RobotData data(model);
  update_velocities(model, state, data);
  Eigen::MatrixXd M;
  mass_matrix(model, data, M);
  for (int j = 0; j < model.dof_count(); ++j)
    M(6 + j, 6 + j) += model.limits().servo[static_cast<size_t>(j)].rotor_inertia;
  return 0.5 * state.velocity().dot(M * state.velocity()) + model.mass() * kGravity * data.cog.z();
}

}  // namespace ayumi::test
