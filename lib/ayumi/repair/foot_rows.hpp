#pragma once
// Rows of the soles: standing ones stay in their places, swinging ones stay over the ground, come
// down over their places, and pass high enough; locked ones keep their paths.

#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

bool is_of_foot(ConstraintGroup group);

/// Position [m] and rotation [rad], world axes, of a sole from where it should be: a stance row.
Vector6d sole_deviation(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& planned);

/// Offset of a sole from its place apart from its height: along the ground and, times half the
/// sole's size, around three axes [m]. Landing rows are factor * height^2 -+ this.
Eigen::Matrix<double, 5, 1> landing_offset(const RobotModel& model, Side side,
                                           const Eigen::Isometry3d& actual,
                                           const Eigen::Isometry3d& place);

/// From the deviation of a sole to landing_offset().
Eigen::Matrix<double, 5, 6> landing_rows(const RobotModel& model, Side side,
                                         const Eigen::Isometry3d& place);

Eigen::VectorXd foot_values(const RobotModel& model, const ConstraintBlock& block,
                            const CollocationPoint& point, const PointState& state);
/// By the correction's value.
Eigen::MatrixXd foot_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                 const CollocationPoint& point, const PointState& state);

/// Soft goals of swings, taken from the motion's own swings.
struct SwingGoals {
  double landing_factor = 0;  ///< offset <= slack + factor * height^2 of a low sole [1/m]
  double clearance = 0;       ///< height of the corners in the middle half of a swing [m]
};
SwingGoals swing_goals(const RowPlacement& placement);

void place_foot_rows(RowPlacement& placement, int point, const SwingGoals& goals);

}  // namespace ayumi
