#pragma once
// The workspace of the dynamics: everything that was computed from a model and a state. All vectors
// are in world axes. Positions and spatial quantities (composite inertia, moments) are taken from
// the base origin, so that no digits are lost far from the world's origin.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Mass, first moment and second moment of a set of bodies about the base origin, in world axes.
struct SpatialInertia {
  double mass = 0;                                    ///< mass of the bodies [kg]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< mass * (com - p_WB) [kg m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< inertia about the base origin [kg m^2]
};

struct RobotData {
  /// The data belong to this model from now on and hold its masses and placements.
  explicit RobotData(const RobotModel& model,
                     const kernels::Kernels& kernels = kernels::best_kernels());

  // The members up to `cog` are filled by update_positions().
  std::vector<Eigen::Matrix3d> rotation;  ///< R_WK of each body
  std::vector<Eigen::Vector3d> position;  ///< p_WK - p_WB of each body origin [m]
  std::vector<Eigen::Vector3d> axis;      ///< joint axis of each body (zero for the root)
  std::vector<Eigen::Vector3d> com;       ///< centre of mass of each body, from the base origin [m]
  Eigen::Vector3d base_position;          ///< p_WB, copied from the state [m]
  Eigen::Vector3d cog_offset;             ///< p_WG - p_WB [m]
  Eigen::Vector3d cog;                    ///< p_WG, world [m]

  // The members up to `dcog` are filled by update_velocities().
  std::vector<Eigen::Vector3d> angular_velocity;  ///< w_WK [rad/s]
  std::vector<Eigen::Vector3d> velocity;          ///< velocity of each body origin [m/s]
  Eigen::Vector3d dcog;                           ///< velocity of the COG [m/s]

  /// Inertia of each subtree; scratch of the Jacobians of the COG.
  std::vector<SpatialInertia> composite;

  // Constants of the model.
  std::vector<double> subtree_mass;  ///< mass of each subtree [kg]
  std::vector<kernels::Link> links;
  /// Layout of a dense mass matrix, by velocity column.
  std::vector<int> column_begin, column, rank;
  const kernels::Kernels* kernels;

  struct alignas(64) Line {
    double number[8];
  };
  std::vector<Line> scratch;  ///< scratch of the kernels

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
