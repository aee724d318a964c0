#pragma once
// Workspace of the dynamics: what was computed from a model and a state. All vectors are in world
// axes. Positions and spatial quantities (composite inertia, moments) are taken from the base
// origin, so that nothing loses digits far from the world's origin.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Mass, first moment and second moment of a set of bodies, world axes, about the base origin.
struct SpatialInertia {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< mass * (com - p_WB) [kg m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the base origin [kg m^2]
};

struct RobotData {
  /// Belongs to this model from now on: it holds its masses and placements.
  explicit RobotData(const RobotModel& model,
                     const kernels::Kernels& kernels = kernels::best_kernels());

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

  std::vector<SpatialInertia> composite;  ///< of each subtree; scratch of the Jacobians of the COG

  // Constants of the model.
  std::vector<double> subtree_mass;  ///< [kg]
  std::vector<kernels::Link> links;
  std::vector<int> column_begin, column, rank;  ///< by velocity column, of a dense mass matrix
  const kernels::Kernels* kernels;

  struct alignas(64) Line {
    double number[8];
  };
  std::vector<Line> scratch;  ///< of the kernels

  kernels::Tree tree() const;
  kernels::Bodies bodies();

  /// Pose of a body in the world.
  Eigen::Isometry3d pose(int body) const {
    Eigen::Isometry3d p = Eigen::Isometry3d::Identity();
    p.linear() = rotation[body];
    p.translation() = base_position + position[body];
    return p;
  }
};

}  // namespace ayumi
