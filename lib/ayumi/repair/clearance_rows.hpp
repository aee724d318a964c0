#pragma once
// The clearance of two shapes as rows of a program. Their nearest points jump from corner to corner
// while faces pass each other, and with them the derivative of the distance: a solver that sees
// that row goes to and fro between the corners. Rows are therefore the signed distances of what the
// shapes end in: of either one's corners (box), end points (capsule) or end discs (cylinder) from
// the other shape. None of them is ever less than the clearance, and outside the other shape each
// has a continuous derivative. The clearance itself is a row where edge meets edge, which none of
// the others tells, and for shapes without ends (spheres, hulls).

#include <Eigen/Core>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

/// A shape of either body of a pair.
struct ShapePair {
  int pair = 0;        ///< of the bodies
  int a = 0, b = 0;    ///< shapes of the one and of the other
  bool edges = false;  ///< the clearance is a row although there are others
};

/// What the clearance may be less than other rows beside it: where these say the same, they do [m].
inline constexpr double kEdgeAllowance = 1e-4;

/// The shapes of a pair of bodies.
std::vector<ShapePair> shape_pairs(const CollisionModel& collisions, int pair);

/// 1 for two spheres; 16 for two boxes, 17 with their edges.
int clearance_rows(const CollisionModel& collisions, const ShapePair& shapes);

/// Whether edges are nearer than any end; needs update_positions().
bool edges_meet(const CollisionModel& collisions, const ShapePair& shapes, const RobotData& data);

/// Clearance of the two shapes; needs update_positions(). Where the bounding spheres are farther
/// apart than `skip`, that bound is returned instead [m].
double shape_clearance(const CollisionModel& collisions, const ShapePair& shapes,
                       const RobotData& data, double skip);

/// The clearance itself first where it is a row, then the ends of b from a, the ends of a from b
/// [m]; needs update_positions().
std::vector<Closest> clearance_points(const CollisionModel& collisions, const ShapePair& shapes,
                                      const RobotData& data);

/// Signed distance of a point from a box of half sides `half` at `pose`: `on_a` on the box, `on_b`
/// the point, `normal` away from the box [m].
Closest point_from_box(const Eigen::Vector3d& point, const Eigen::Isometry3d& pose,
                       const Eigen::Vector3d& half);

/// By the tangent of the configuration (world), rows x (6+dof).
Eigen::MatrixXd clearance_gradient(const RobotModel& model, const CollisionModel& collisions,
                                   const ShapePair& shapes, const RobotData& data);

}  // namespace ayumi
