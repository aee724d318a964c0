#pragma once
// The place of the ground in a picture, and the softening of the shadow on it.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ayumi/render/camera.hpp"

namespace ayumi {

/// Frame of the ground plane, and the square of this plane on which the robot's shadow falls.
struct GroundRectangle {
  Eigen::Vector3d origin, u, v, normal;
  Eigen::Vector2d center;
  double reach = 1;  ///< half of the square's edge [m]
};

/// `frame` lies in the plane, and z is its normal; `box` encloses everything that throws the
/// shadow, and `sun` points to the light.
GroundRectangle ground_rectangle(const Eigen::Isometry3d& frame, const Eigen::AlignedBox3d& box,
                                 const Eigen::Vector3d& sun);

/// The map along the sun onto the plane, in which the square of the shadow becomes -1..1 and the
/// depth 0.
Eigen::Matrix4d flattening(const GroundRectangle& ground, const Eigen::Vector3d& sun);

/// The direction to the sun, a unit vector: over the camera's left shoulder, whatever the camera
/// looks at.
Eigen::Vector3d sun_behind(const Camera& camera, const Eigen::Vector3d& up);

/// The height in the picture at which the ground vanishes straight ahead, where -1 is the bottom of
/// the picture and 1 its top.
double horizon_height(const Camera& camera, const Eigen::Vector3d& normal,
                      const Eigen::Matrix4f& to_clip);

/// The middle and half the edges of the part of a square picture that is not zero, with one pixel
/// more on every side. The edges of the picture are at -1 and 1. If everything is zero, half the
/// edges are 0.
Eigen::Vector4f covered(const std::vector<std::uint8_t>& image, int size);

/// Blurs a square picture in place: two passes of a box of 2 radius + 1 along rows and columns.
void blur(std::vector<std::uint8_t>& image, int size, int radius);

}  // namespace ayumi
