#pragma once
// Where the search for a correction begins.

#include <Eigen/Core>
#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

/// Control points of the same uniform cubic spline with knots half as far apart.
Eigen::MatrixXd with_halved_knots(const Eigen::MatrixXd& coefficients);

/// Control points, `rows` of them `spacing` [s] apart, that lead the joints the errors are about
/// straight over: from `reach` [s] before an error to `reach` after it, with the angles and speeds
/// the motion has there. A joint beyond its limit is taken back so, and of two bodies that overlap
/// all joints between them.
Eigen::MatrixXd bridge(const RobotModel& model, const CommandSeries& series,
                       const std::vector<Finding>& findings, double reach, double spacing,
                       Eigen::Index rows);

/// A start for the program: no correction, or where that is far off in what is least linear (soles
/// and clearances) the bridge that violates least there.
Eigen::VectorXd start_of(const CorrectionProblem& problem, const Nlp& nlp, const RobotModel& model,
                         const CommandSeries& series, const std::vector<Finding>& findings);

}  // namespace ayumi
