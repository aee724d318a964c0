#pragma once
// One box without joints.

#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

inline constexpr double kStep = 1e-3;  ///< step of the integrator [s]

/// A homogeneous box with edges `size` [m] and `mass` [kg], which is its own collision shape.
inline RobotDescription block_description(const Eigen::Vector3d& size, double mass) {
  RobotDescription d;
  d.name = "block";
  LinkDescription link;
  link.name = "block";
  link.has_inertial = true;
  link.inertia.mass = mass;
  const Eigen::Vector3d e = size.cwiseProduct(size);
  link.inertia.about_com =
      (mass / 12.0 * Eigen::Vector3d(e.y() + e.z(), e.x() + e.z(), e.x() + e.y())).asDiagonal();
  PlacedShape shape;
  shape.shape = Box{size};
  link.collisions.push_back(shape);
  d.links.push_back(link);
  return d;
}

}  // namespace ayumi::test
