#pragma once
// The points of a robot that may touch the ground: the corners of its soles and of its collision
// shapes. Each has its spring.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// A point of a body, or the lowest point of a sphere or circle around it, with its spring.
struct ContactPoint {
  int body = 0;
  Eigen::Vector3d position;  ///< position in the body frame [m]
  double radius = 0;         ///< radius of the sphere around it [m]
  /// The radius of a circle around the point [m]. The lowest point of the circle touches the
  /// ground. The circle is the end of a cylinder that can roll. A level circle has no lowest point;
  /// other points then carry the cylinder.
  double rim = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< axis of the circle in the body frame
  double stiffness = 0;                            ///< stiffness of the contact [N/m]
  double damping_time = 0;                         ///< ratio of damping to stiffness [s]
  int side = -1, vertex = -1;  ///< Side of the sole, and its vertex; -1 if it is not part of a sole
};

/// Consecutive points of one body, and a sphere that contains them, in the body frame.
struct PointGroup {
  int body = 0, first = 0, count = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// The points of the soles (left, then right, in the order of their polygons), then the points of
/// the collision shapes of all links that are not part of a foot. These are corners of boxes,
/// centres of spheres, ends of capsules, eight corners and the rim of each end of a cylinder, and
/// vertices of meshes (of large meshes, those that are farthest out in 90 directions). Points of
/// the link above a foot that the sole shields from the ground at home are left out.
std::vector<ContactPoint> contact_points(const RobotModel& model);

/// The stiffness of a contact point of a body that is not a sole: almost rigid [N/m].
double body_stiffness(const RobotModel& model);
/// Ratio of damping to stiffness of such a point [s]. Chosen: four steps of 1 ms, so that an impact
/// of a body is inelastic. Between half and twice the value, figures change by less than 5 %.
constexpr double kBodyDamping = 0.004;

std::vector<PointGroup> group_points(const std::vector<ContactPoint>& points);

/// Wachspress coordinates of the point p in a convex polygon: the weights of the corners are not
/// negative, their sum is 1, and the weighted sum of the corners is p.
void corner_weights(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p,
                    std::vector<double>& weights);

}  // namespace ayumi
