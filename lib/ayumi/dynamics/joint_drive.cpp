#include "ayumi/dynamics/joint_drive.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

using Eigen::VectorXd;

JointDrive joint_drive(const ActuatorLimits& actuators) {
  const auto n = static_cast<int>(actuators.servo.size());
  JointDrive drive{VectorXd(n), VectorXd(n), VectorXd(n)};
  for (int j = 0; j < n; ++j) {
    const ServoDescription& servo = actuators.servo[static_cast<size_t>(j)];
    drive.rotor_inertia[j] = servo.rotor_inertia;
    drive.viscous[j] = servo.viscous;
    drive.coulomb[j] = servo.coulomb;
  }
  return drive;
}

double friction_torque(const JointDrive& drive, int dof, double rate) {
  return drive.viscous[dof] * rate +
         drive.coulomb[dof] * std::clamp(rate / drive.stick_rate, -1.0, 1.0);
}

double friction_slope(const JointDrive& drive, int dof, double rate) {
  const bool sticks = std::abs(rate) < drive.stick_rate;
  return drive.viscous[dof] + (sticks ? drive.coulomb[dof] / drive.stick_rate : 0.0);
}

VectorXd drive_torque(const JointDrive& drive, const VectorXd& dtheta, const VectorXd& ddtheta) {
  VectorXd torque = drive.rotor_inertia.cwiseProduct(ddtheta);
  for (int j = 0; j < torque.size(); ++j) torque[j] += friction_torque(drive, j, dtheta[j]);
  return torque;
}

}  // namespace ayumi
