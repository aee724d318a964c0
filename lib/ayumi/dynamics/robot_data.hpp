#pragma once
// Workspace of the dynamics: what was computed from a model and a state. All vectors are in world
// axes. Positions and spatial quantities (composite inertia, moments) are taken from the base
// origin, so that nothing loses digits far from the world's origin.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Mass, first moment and second moment of a set of bodies, world axes, about the base origin.
struct SpatialInertia {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< mass * (com - p_WB) [kg m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the base origin [kg m^2]
};

/// Of one body in articulated_body_acceleration(): spatial vectors (linear part first) about the
/// base origin.
struct ArticulatedBody {
  using Vector = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> inertia;
  Vector screw, bias, twist, acceleration, drift;  ///< drift: V x S dq
  Vector force;                                    ///< U = I S
  double inverse = 0, drive = 0;                   ///< 1 / S.U, tau - S.bias
};

struct RobotData {
  explicit RobotData(const RobotModel& model);

  // Filled by update_positions().
  std::vector<Eigen::Matrix3d> rotation;  ///< R_WK of each body
  std::vector<Eigen::Vector3d> position;  ///< p_WK - p_WB of each body origin [m]
  std::vector<Eigen::Vector3d> axis;      ///< joint axis of each body (zero for the root)
  std::vector<Eigen::Vector3d> com;       ///< of each body, from the base origin [m]
  Eigen::Vector3d base_position;          ///< p_WB, copied from the state [m]
  Eigen::Vector3d cog_offset;             ///< p_WG - p_WB [m]
  Eigen::Vector3d cog;                    ///< p_WG, world [m]

  // Filled by update_velocities().
  std::vector<Eigen::Vector3d> angular_velocity;  ///< w_WK [rad/s]
  std::vector<Eigen::Vector3d> velocity;          ///< of each body origin [m/s]
  Eigen::Vector3d dcog;                           ///< [m/s]

  // Scratch of inverse_dynamics() and mass_matrix().
  std::vector<Eigen::Vector3d> angular_acceleration, acceleration;
  std::vector<Eigen::Vector3d> force, moment;  ///< of each subtree, moment about the base origin
  std::vector<SpatialInertia> composite;       ///< of each subtree

  std::vector<ArticulatedBody> articulated;  ///< sized by its first use

  // Constants of the model that save work.
  std::vector<double> subtree_mass;  ///< [kg]
  std::vector<int> aligned;          ///< joint axis 1, 2, 3 for x, y, z, negative reversed; else 0
  std::vector<char> turned;          ///< the joint frame is turned against its parent's

  /// Pose of a body in the world.
  Eigen::Isometry3d pose(int body) const {
    Eigen::Isometry3d p = Eigen::Isometry3d::Identity();
    p.linear() = rotation[body];
    p.translation() = base_position + position[body];
    return p;
  }
};

}  // namespace ayumi
