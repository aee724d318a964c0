#pragma once
// The clearance of two shapes as distances with continuous derivatives. While faces pass each
// other, the nearest points of two shapes jump from corner to corner, and the derivative of the
// distance jumps with them: a solver that uses this distance alternates between the corners. So the
// distances here are those of the ends of each shape from the other shape; ends are corners (box),
// end points (capsule) or end discs (cylinder). None of these distances is less than the clearance,
// and outside the other shape each has a continuous derivative. The clearance itself is added for
// shapes without ends (spheres, hulls), and if two edges are nearest to each other, because the
// distances of the ends do not show this case.

#include <Eigen/Core>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

/// One shape of each body of a pair.
struct ShapePair {
  int pair = 0;        ///< index of the pair of bodies
  int a = 0, b = 0;    ///< index of the shape of the first and of the second body
  bool edges = false;  ///< whether the clearance itself is a row, too
};

/// The shapes of a pair of bodies.
std::vector<ShapePair> shape_pairs(const CollisionModel& collisions, int pair);

/// The number of clearance_points(): 1 for two spheres; 16 for two boxes, or 17 with their edges.
int clearance_point_count(const CollisionModel& collisions, const ShapePair& shapes);

/// Whether two edges are nearer than any end, by more than `same_distance` [m]. Needs
/// update_positions().
bool edges_meet(const CollisionModel& collisions, const ShapePair& shapes, const RobotData& data,
                double same_distance);

/// The clearance of the two shapes. If the bounding spheres are farther apart than `skip`, their
/// distance is returned instead [m]. Needs update_positions().
double shape_clearance(const CollisionModel& collisions, const ShapePair& shapes,
                       const RobotData& data, double skip);

/// First the clearance itself if it is a row, then the distances of the ends of b from a, then
/// those of the ends of a from b [m]. Needs update_positions().
std::vector<Closest> clearance_points(const CollisionModel& collisions, const ShapePair& shapes,
                                      const RobotData& data);

/// The signed distance of a point from a box with half sides `half` at `pose` [m]: `on_a` is on the
/// box, `on_b` is the point, and `normal` points away from the box.
Closest point_from_box(const Eigen::Vector3d& point, const Eigen::Isometry3d& pose,
                       const Eigen::Vector3d& half);

/// The derivatives of clearance_points() by the tangent of the configuration (world), points x
/// (6+dof).
Eigen::MatrixXd clearance_gradient(const RobotModel& model, const CollisionModel& collisions,
                                   const ShapePair& shapes, const RobotData& data);

}  // namespace ayumi
