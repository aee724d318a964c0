#pragma once
// The Hessian of the program. It is that of the objective, which is constant, plus, on the ground,
// the curvature of the constraints times their multipliers (curvature.hpp). The objective is
//   kObjectiveScale / 2 * sum_columns w integral (d^2 + tau^4 d''^2) dt,
// quadratic in the control points, by the Gram matrices of the splines.

#include <array>
#include <vector>

#include "ayumi/repair/collocation.hpp"
#include "ayumi/repair/curvature.hpp"
#include "ayumi/repair/nlp/nlp.hpp"

namespace ayumi {

struct ProgramHessian {
  SparsePattern pattern;      ///< the nonzeros of the objective, then those of the curvature
  Eigen::VectorXd objective;  ///< values of the first nonzeros
  std::vector<int> columns;   ///< columns of the correction that are curved; empty if there is none
  std::vector<int> first_nonzero;  ///< first nonzero of the four pairs of each control point
};

/// `weights` are change_weights(), for each column.
ProgramHessian program_hessian(const RobotModel& model, const Eigen::VectorXd& weights,
                               const CorrectionVariables& variables,
                               const std::vector<CollocationPoint>& points);

/// The gradient of the objective at x.
void objective_gradient(const ProgramHessian& hessian, const Eigen::VectorXd& x,
                        Eigen::VectorXd& gradient);

/// Curvature of the rows of one point, for the columns that are curved.
struct PointCurvature {
  SplineWeights weights;
  /// Second derivatives by value and value, by acceleration and value, and the transpose of
  /// `mixed`. Empty if nothing is curved.
  Eigen::MatrixXd value, mixed, turned;
  Eigen::Matrix2d cone = Eigen::Matrix2d::Zero();  ///< second derivatives by the tangential force
  std::array<Eigen::MatrixXd, 4> force;  ///< derivatives of this force by each control point
};
PointCurvature curvature_at(const ProgramHessian& hessian, const SplineWeights& weights,
                            const Curvature& curvature);

/// Adds the curvature of all points, in order of time, to the values of the nonzeros. `index` is
/// that of CorrectionVariables.
void add_curvature(const ProgramHessian& hessian, const Eigen::MatrixXi& index,
                   const std::vector<PointCurvature>& points, int threads, Eigen::VectorXd& values);

}  // namespace ayumi
