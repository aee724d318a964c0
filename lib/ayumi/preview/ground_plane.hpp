#pragma once
// Where the ground is in a picture, and the softening of the shadow on it.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ayumi/preview/camera.hpp"

namespace ayumi {

/// Frame of the ground plane and the square of it that the robot's shadow falls
/// on.
struct Ground {
  Eigen::Vector3d origin, u, v, normal;
  Eigen::Vector2d center;
  double reach = 1;  ///< half edge of the square [m]
};

/// The plane through `origin`; `box` bounds what throws the shadow, `sun` points to the light.
Ground make_ground(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal,
                   const Eigen::AlignedBox3d& box, const Eigen::Vector3d& sun);

/// The sun over the camera's left shoulder, whatever side it looks from; unit.
Eigen::Vector3d sun_behind(const Camera& camera, const Eigen::Vector3d& up);

/// Where the ground vanishes straight ahead, -1 at the bottom of the picture, 1
/// at its top.
double horizon_height(const Camera& camera, const Eigen::Vector3d& normal,
                      const Eigen::Matrix4f& to_clip);

/// Two passes of a box of 2 radius + 1 along rows and columns of a square
/// picture, in place.
void blur(std::vector<std::uint8_t>& image, int size, int radius);

}  // namespace ayumi
