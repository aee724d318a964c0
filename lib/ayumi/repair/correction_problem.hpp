#pragma once
// The least correction of a motion as a nonlinear program:
//   minimize    the weighted change (program_hessian.hpp)
//   subject to  rows of the limits at collocation points (row_placement.hpp)
//   over        free control points of a spline (collocation.hpp)
// Derivatives of the rows are exact. The Hessian is that of the objective plus, while the robot is
// on the ground, the curvature of the rows.

#include <span>
#include <vector>

#include "ayumi/repair/correction_spec.hpp"
#include "ayumi/repair/nlp/nlp.hpp"
#include "ayumi/repair/point_states.hpp"
#include "ayumi/repair/program_hessian.hpp"
#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

/// The model and the series must outlive this object. Its functions use several threads themselves,
/// so only one thread may call them at a time.
class CorrectionProblem {
 public:
  CorrectionProblem(const RobotModel& model, const CommandSeries& series,
                    const CorrectionSpec& spec);

  int variable_count() const { return variables_.count; }
  int constraint_count() const { return static_cast<int>(rows_.lower.size()); }
  const std::vector<RowBlock>& blocks() const { return rows_.blocks; }
  const std::vector<CollocationPoint>& points() const { return points_; }
  const Eigen::VectorXd& lower() const { return rows_.lower; }  ///< bounds of the rows
  const Eigen::VectorXd& upper() const { return rows_.upper; }

  Eigen::VectorXd constraints(const Eigen::VectorXd& x) const;
  /// The values of the rows for another motion with the same plan and the same samples.
  Eigen::VectorXd constraints_of(const CommandSeries& motion) const;

  /// The samples beside the points at which a single row is active (RowBlock::active).
  std::vector<ActiveLimit> beside_active(const Eigen::VectorXd& x) const;

  /// The program. It refers to this object, which must outlive it.
  Nlp nlp() const;

  /// The correction for the variables x, and the variables for control points.
  CorrectionTrack track(const Eigen::VectorXd& x) const;
  Eigen::VectorXd point(const Eigen::MatrixXd& coefficients) const;

 private:
  Eigen::VectorXd values(PointStates& states, const Eigen::MatrixXd& coefficients) const;
  std::span<const RowBlock> blocks_of(size_t point) const;
  void jacobian_values(const Eigen::VectorXd& x, Eigen::VectorXd& values) const;
  void add_curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& values) const;

  const RobotModel& model_;
  const ActuatorLimits& actuators_;
  CorrectionSpec spec_;
  ContactPlan plan_;
  CorrectionVariables variables_;
  std::vector<CollocationPoint> points_;
  PlacedRows rows_;
  std::vector<size_t> first_block_;  ///< first block of each point, with one more entry at the end
  std::vector<int> first_nonzero_;   ///< first nonzero of each block in the Jacobian
  SparsePattern jacobian_;
  ProgramHessian hessian_;
  mutable PointStates
      states_;  ///< states for the last x; the functions of one program run on one thread
  mutable std::vector<PointCurvature> curvature_;  ///< curvature of each point
};

}  // namespace ayumi
