#pragma once
// What goes into a plant's step and what comes out of it, the same for every plant.

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace ayumi {

/// A force or couple from outside during one step.
struct ExternalWrench {
  int body = -1;  ///< -1: through the whole-body COG, on the trunk
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< world [m]; unused for body -1
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< world [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< world [N m]
};

/// Ground force at one vertex of a sole.
struct SoleForce {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< on the robot, world [N]
  double gap = 0;                                      ///< to the ground, negative inside [m]
};

/// What a step did, averaged over its duration.
struct StepReport {
  Eigen::VectorXd torque;                       ///< of the servos [N m]
  std::array<std::vector<SoleForce>, 2> soles;  ///< by Side, in the order of the sole's polygon
  bool body_contact = false;                    ///< something but a sole touches the ground
  std::vector<int> saturated;                   ///< dofs whose torque is at its limit
  int contact_iterations = 0;
  double contact_residual = 0;  ///< [m/s]
  double max_penetration = 0;   ///< of a sole vertex [m]
};

}  // namespace ayumi
