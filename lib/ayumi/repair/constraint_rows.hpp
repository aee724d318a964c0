#pragma once
// The rows of the program at one collocation point, and their exact derivatives by the correction's
// value, rate and acceleration there (6 + dof columns each: base position, base rotation vector,
// joints). Values are the figures of the check. Each kind of row is described in
// constraint_group.hpp and written in ground_rows, foot_rows, joint_rows, clearance_rows or
// command_rows.

#include <array>
#include <vector>

#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/repair/clearance_points.hpp"
#include "ayumi/repair/collocation.hpp"
#include "ayumi/repair/corrected_motion.hpp"

namespace ayumi {

/// Consecutive rows that belong together.
struct ConstraintBlock {
  ConstraintGroup group = ConstraintGroup::support;
  int point = 0;          ///< index of its CollocationPoint
  int item = 0;           ///< foot (by Side), dof, or pair of bodies
  ShapePair shapes;       ///< of clearance rows
  int row = 0, rows = 0;  ///< first row and their number
  double scale = 1;       ///< of friction and torsional friction: 1 / (m g); of joints: 1 / limit
  double factor = 0;      ///< of friction: mu; of torsional friction: mu times arm [m];
                          ///< of landings [1/m]; of the DCM: 1 / omega [s]
  Eigen::Matrix<double, Eigen::Dynamic, 6> wrench_rows;  ///< of rows linear in the ground wrench
};

/// A block without what only some groups have.
ConstraintBlock block_of(ConstraintGroup group, int point, int item, int rows, double scale = 1);

/// What the blocks of one collocation point share.
struct PointState {
  Eigen::VectorXd change;  ///< value of the correction (6 + dof)
  CorrectedMotion motion;
  Vector6d wrench = Vector6d::Zero();        ///< of the ground, about the base
  std::array<Eigen::MatrixXd, 3> wrench_by;  ///< 6 x (6+dof) by value, rate, acceleration
  std::array<Eigen::Isometry3d, 2> soles;    ///< by Side
  std::array<Eigen::MatrixXd, 2> sole_by;    ///< 6 x (6+dof) by value
  Eigen::MatrixXd cog_by;                    ///< 3 x (6+dof) by value
  Eigen::VectorXd torque;                    ///< where the point needs it [dof]
  std::array<Eigen::MatrixXd, 3> torque_by;  ///< dof x (6+dof)
  /// The workspace it was computed in; valid until the next point_state().
  RobotData* data = nullptr;
};
/// `derivatives`: what computes them; null: values alone.
PointState point_state(const RobotModel& model, const CommandSample& sample,
                       const CollocationPoint& point, const Eigen::MatrixXd& coefficients,
                       TreeDynamics* derivatives, RobotData& data);

/// Columns of the correction on which a block depends, in order.
std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& point);

Eigen::VectorXd block_values(const RobotModel& model, const ConstraintBlock& block,
                             const CollocationPoint& point, const PointState& state);

/// By value, rate and acceleration, rows x (6+dof) each; an empty matrix where all is zero.
std::array<Eigen::MatrixXd, 3> block_derivatives(const RobotModel& model,
                                                 const ConstraintBlock& block,
                                                 const CollocationPoint& point,
                                                 const PointState& state);

}  // namespace ayumi
