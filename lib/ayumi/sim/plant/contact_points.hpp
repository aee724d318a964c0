#pragma once
// The points of a robot that may touch the ground: corners of its soles and of its collision
// shapes.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// A point with its spring.
struct ContactPoint {
  int body = 0;
  Eigen::Vector3d position;  ///< body frame [m]
  double radius = 0;         ///< of a sphere around it [m]
  /// Of a circle around it, whose lowest point is the one that touches [m]: an end of a cylinder
  /// that rolls. Where the circle lies level no point is the lowest, and others hold the cylinder.
  double rim = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of that circle, body frame
  double stiffness = 0;                            ///< [N/m]
  double damping_time = 0;                         ///< [s]
  int side = -1, vertex = -1;                      ///< of a sole, else -1
};

/// Consecutive points of one body and a sphere around them, body frame.
struct PointGroup {
  int body = 0, first = 0, count = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Soles first (left, right, in the order of their polygons), then the collision shapes of all
/// links that are not part of a foot: corners of boxes, spheres, ends of capsules, eight corners
/// and the rim of a cylinder's ends, vertices of meshes (of large ones those farthest out in 90
/// directions).
std::vector<ContactPoint> contact_points(const RobotModel& model);

/// Spring of a point of a body that is no sole: almost rigid.
double body_stiffness(const RobotModel& model);  ///< [N/m]
constexpr double kBodyDamping = 0.004;           ///< damping / stiffness [s]

std::vector<PointGroup> group_points(const std::vector<ContactPoint>& points);

/// Weights of a convex polygon's corners that make up the point p within it (Wachspress): all
/// non-negative, their sum is 1 and the weighted corners give p.
void corner_weights(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p,
                    std::vector<double>& weights);

}  // namespace ayumi
