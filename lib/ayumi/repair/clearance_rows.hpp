#pragma once
// Rows that keep shapes of two bodies apart (clearance_points.hpp).

#include "ayumi/repair/row_placement.hpp"

namespace ayumi {

/// Base and joints are left out where they move both bodies alike: the paths of the two bodies.
std::vector<int> clearance_columns(const RobotModel& model, const CollisionModel& collisions,
                                   const ShapePair& shapes);

Eigen::VectorXd clearance_values(const ConstraintBlock& block, const CollocationPoint& point,
                                 const PointState& state);
Eigen::MatrixXd clearance_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                      const CollocationPoint& point, const PointState& state);

/// Bodies come no nearer than the band of policy.hpp, or than the motion brings them by itself
/// without a touch. Shapes are watched from farther away than bodies, because the next nearest ones
/// are not far.
void place_clearance_rows(RowPlacement& placement, int point);

}  // namespace ayumi
