#pragma once
// State of a robot. Generalised velocity: [v_WB; w_WB; dtheta], base parts in world axes.

#include <Eigen/Geometry>

namespace ayumi {

struct BasePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_WB [m]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< R_WB as a unit quaternion
};

struct RobotState {
  BasePose base;
  Eigen::Vector3d base_velocity = Eigen::Vector3d::Zero();          ///< v_WB, world axes [m/s]
  Eigen::Vector3d base_angular_velocity = Eigen::Vector3d::Zero();  ///< w_WB, world axes [rad/s]
  Eigen::VectorXd theta;   ///< joint angles or positions by dof [rad] or [m]
  Eigen::VectorXd dtheta;  ///< their rates by dof [rad/s] or [m/s]

  /// [v_WB; w_WB; dtheta], 6 + dof.
  Eigen::VectorXd velocity() const {
    Eigen::VectorXd v(6 + dtheta.size());
    v << base_velocity, base_angular_velocity, dtheta;
    return v;
  }
};

}  // namespace ayumi
