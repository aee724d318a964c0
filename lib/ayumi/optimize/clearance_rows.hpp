#pragma once
// The clearance of two bodies as rows of a program. Of two boxes the nearest points jump from
// corner to corner while faces pass each other, and so does the derivative of their distance: a
// solver that sees that row alone goes to and fro between the corners. Where each body is one box,
// the signed distances of either box's corners from the other box are rows too; none of them is
// ever less than the clearance, and outside a box each has a continuous derivative.

#include <Eigen/Core>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

/// 1, or 17 for two bodies of one box each.
int clearance_rows(const CollisionModel& collisions, int pair);

/// The clearance itself first, then corners of b from a, corners of a from b [m]; needs
/// update_positions().
std::vector<Closest> clearance_points(const CollisionModel& collisions, int pair,
                                      const RobotData& data);

/// Signed distance of a point from a box of half sides `half` at `pose`: `on_a` on the box, `on_b`
/// the point, `normal` away from the box [m].
Closest point_from_box(const Eigen::Vector3d& point, const Eigen::Isometry3d& pose,
                       const Eigen::Vector3d& half);

/// By the tangent of the configuration (world), rows x (6+dof).
Eigen::MatrixXd clearance_gradient(const RobotModel& model, const CollisionModel& collisions,
                                   int pair, const RobotData& data);

}  // namespace ayumi
