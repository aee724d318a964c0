#pragma once
// The initial guess of the search for a correction.

#include <Eigen/Core>
#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The control points of the same uniform cubic spline for half the distance between knots.
Eigen::MatrixXd with_halved_knots(const Eigen::MatrixXd& coefficients);

/// `rows` control points at a distance of `spacing` [s] that lead the joints at fault straight past
/// the errors, from `reach` [s] before an error to `reach` after it. At these two times, the joints
/// have the angles and speeds of the motion. For a joint beyond its limit, only this joint is
/// moved. For two bodies that overlap, all joints between them are moved.
Eigen::MatrixXd straight_line_guess(const RobotModel& model, const CommandSeries& series,
                                    const std::vector<Finding>& findings, double reach,
                                    double spacing, Eigen::Index rows);

/// The variables of the program for random control points.
Eigen::VectorXd random_start(const CorrectionProblem& problem, const RandomStart& how);

/// The point from which the program starts. It is the start of `nlp`, unless this start violates
/// the strongly nonlinear rows (soles and clearances) by much. In this case it is the straight-line
/// guess with the smallest violation of these rows, if this violation is smaller than that of the
/// start.
Eigen::VectorXd initial_guess(const CorrectionProblem& problem, const Nlp& nlp,
                              const RobotModel& model, const CommandSeries& series,
                              const std::vector<Finding>& findings);

}  // namespace ayumi
