#pragma once
// The quantities of a corrected motion at one collocation point, and their derivatives by the
// correction's value, rate and acceleration there (6 + dof columns each: base position, base
// rotation vector, joints). From these follow the values and derivatives of the rows that limits
// place (limits/row.hpp).

#include <array>
#include <vector>

#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/corrected_motion.hpp"

namespace ayumi {

struct PointState {
  explicit PointState(const RobotData& workspace) : data(workspace) {}

  Eigen::VectorXd change, rate, second;  ///< value of the correction and its derivatives (6 + dof)
  CorrectedMotion motion;
  RobotData data;                          ///< positions and velocities of `motion`
  Eigen::VectorXd force;                   ///< result of inverse_dynamics() (6 + dof)
  Vector6d wrench = Vector6d::Zero();      ///< wrench of the ground, about the base
  std::array<Eigen::Isometry3d, 2> soles;  ///< poses of the soles, by Side
  Eigen::VectorXd torque;                  ///< torques, if the point needs them [dof]
  /// Derivatives by value, rate and acceleration, 6 x (6+dof) each.
  std::array<Eigen::MatrixXd, 3> wrench_by;
  std::array<Eigen::MatrixXd, 2> sole_by;  ///< derivatives by value, 6 x (6+dof)
  Eigen::MatrixXd cog_by;                  ///< derivative by value, 3 x (6+dof)
  /// Derivatives by value, rate and acceleration, dof x (6+dof) each.
  std::array<Eigen::MatrixXd, 3> torque_by;
};

/// Memory for the computation of derivatives.
struct DerivativeWorkspace {
  explicit DerivativeWorkspace(const RobotModel& model) : dynamics(model) {}
  TreeDynamics dynamics;
  InverseDynamicsDerivatives
      force_by;  ///< derivatives by the correction's value, rate and acceleration
};

/// Fills everything except the derivatives.
void fill_values(const RobotModel& model, const ActuatorLimits& actuators,
                 const CommandSample& sample, const CollocationPoint& point,
                 const Eigen::MatrixXd& coefficients, PointState& state);

/// Fills the derivatives of a state that has its values.
void fill_derivatives(const RobotModel& model, const ActuatorLimits& actuators,
                      const CommandSample& sample, const CollocationPoint& point,
                      DerivativeWorkspace& workspace, PointState& state);

/// The ground wrench about the support plane of the point, in the axes of the plane.
Vector6d plane_wrench(const CollocationPoint& point, const PointState& state);

/// The columns of the correction on which a block depends, in order.
std::vector<int> block_columns(const RobotModel& model, const RowBlock& block);

Eigen::VectorXd block_values(const RobotModel& model, const RowBlock& block,
                             const CollocationPoint& point, const PointState& state);

/// The derivatives by value, rate and acceleration, rows x (6+dof) each. A matrix is empty if all
/// of its entries are zero.
std::array<Eigen::MatrixXd, 3> block_derivatives(const RobotModel& model, const RowBlock& block,
                                                 const CollocationPoint& point,
                                                 const PointState& state);

}  // namespace ayumi
