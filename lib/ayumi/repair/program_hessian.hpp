#pragma once
// The Hessian of the program: that of the objective, which is constant, and on the ground the
// curvature of the constraints times their multipliers (curvature.hpp). The objective is
//   kObjectiveScale / 2 * sum_columns w integral (d^2 + tau^4 d''^2) dt,
// quadratic in the control points, by the Gram matrices of the splines.

#include <vector>

#include "ayumi/repair/collocation.hpp"
#include "ayumi/repair/curvature.hpp"
#include "ayumi/repair/nlp/nlp.hpp"

namespace ayumi {

struct ProgramHessian {
  SparsePattern pattern;           ///< nonzeros of the objective, then those of the curvature
  Eigen::VectorXd objective;       ///< values of the first nonzeros
  std::vector<int> columns;        ///< columns of the correction that curve; empty: none
  std::vector<int> first_nonzero;  ///< of four pairs for every control point
};

/// `weights`: change_weights() by column.
ProgramHessian program_hessian(const RobotModel& model, const Eigen::VectorXd& weights,
                               const CorrectionVariables& variables,
                               const std::vector<CollocationPoint>& points);

/// The gradient of the objective at x.
void objective_gradient(const ProgramHessian& hessian, const Eigen::VectorXd& x,
                        Eigen::VectorXd& gradient);

/// Curvature of the blocks of one point, by pairs of control points: 4 * later point + distance.
using ControlPointPairs = std::vector<Eigen::MatrixXd>;
void spread_curvature(const ProgramHessian& hessian, const SplineWeights& weights,
                      const Curvature& curvature, ControlPointPairs& pairs);

/// Adds them to the values of the nonzeros.
void add_pairs(const ProgramHessian& hessian, const Eigen::MatrixXi& index,
               const ControlPointPairs& pairs, Eigen::VectorXd& values);

}  // namespace ayumi
