#pragma once
// Rows of the ground wrench: the ZMP inside the support, the normal force, friction, torsional
// friction, flight, and a trusted ZMP. Most are linear in the wrench about the support plane;
// friction and torsional friction are not. The figures are those of demand/ground_demand.hpp.

#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

/// Whether rows of the group are functions of the ground wrench alone.
bool is_of_ground(ConstraintGroup group);

Eigen::VectorXd ground_values(const ConstraintBlock& block, const CollocationPoint& point,
                              const PointState& state);
std::array<Eigen::MatrixXd, 3> ground_derivatives(const ConstraintBlock& block,
                                                  const CollocationPoint& point,
                                                  const PointState& state);

/// Rows by the plane wrench: rows x 6.
Eigen::MatrixXd ground_gradient(const ConstraintBlock& block, const Vector6d& plane_wrench);

/// The tangential force of a friction row, without a kink at 0 [N].
double rounded_tangential_force(const ConstraintBlock& block, const Vector6d& plane_wrench);

/// f_n times the offset of the ZMP from the commanded one, over the weight: 2 x 6.
Eigen::Matrix<double, 2, 6> planned_zmp_rows(const RowPlacement& placement, int point);

/// The normal force above which the ZMP has a meaning [N].
double contact_threshold(const RobotModel& model);

/// Sets the margin that the ZMP is wanted to have at every point. Where the motion's ZMP is outside
/// or too near an edge, and for a while around, that is the safe margin; elsewhere it is a share of
/// the motion's own margin, at most the safe one.
void set_zmp_margins(RowPlacement& placement);

void place_ground_rows(RowPlacement& placement, int point);

}  // namespace ayumi
