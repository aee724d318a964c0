#pragma once
// The torques that gears and motors add to the rigid tree of dynamics/inverse_dynamics.hpp: rotor
// inertia and friction, one entry per dof. Inverse dynamics with drives is the tree's force plus
// drive_torque(); forward dynamics takes the drives as an argument.

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct JointDrive {
  Eigen::VectorXd rotor_inertia;  ///< rotor inertia, reflected through the gear [kg m^2]
  Eigen::VectorXd viscous;        ///< viscous friction [N m s/rad]
  Eigen::VectorXd coulomb;        ///< dry friction [N m]
  double stick_rate = 1e-3;       ///< joint rate below which dry friction falls to zero [rad/s]
};

/// The drives of these servos.
JointDrive joint_drive(const ActuatorLimits& actuators);

/// The torque that friction takes from each dof,
///   viscous dq + coulomb clamp(dq / stick_rate, -1, 1),
/// and its derivative by the rate.
double friction_torque(const JointDrive& drive, int dof, double rate);
double friction_slope(const JointDrive& drive, int dof, double rate);

/// The torque that the motors must give beyond the tree's force, by dof [N m]:
///   rotor ddq + friction.
Eigen::VectorXd drive_torque(const JointDrive& drive, const Eigen::VectorXd& dtheta,
                             const Eigen::VectorXd& ddtheta);

}  // namespace ayumi
