#pragma once
// The place of the ground in a picture, and the softening of the shadow on it.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ayumi/render/camera.hpp"

namespace ayumi {

/// Frame of the ground plane and the square of it that the robot's shadow falls on.
struct GroundRectangle {
  Eigen::Vector3d origin, u, v, normal;
  Eigen::Vector2d center;
  double reach = 1;  ///< half edge of the square [m]
};

/// `frame` lies in the plane, z is its normal; `box` bounds what throws the shadow, `sun` points to
/// the light.
GroundRectangle ground_rectangle(const Eigen::Isometry3d& frame, const Eigen::AlignedBox3d& box,
                                 const Eigen::Vector3d& sun);

/// Along the sun onto the plane: the square of the shadow becomes -1..1, depth 0.
Eigen::Matrix4d flattening(const GroundRectangle& ground, const Eigen::Vector3d& sun);

/// The direction to the sun: over the camera's left shoulder, whatever the camera looks at. A unit
/// vector.
Eigen::Vector3d sun_behind(const Camera& camera, const Eigen::Vector3d& up);

/// Height in the picture at which the ground vanishes straight ahead: -1 is the bottom of the
/// picture, 1 its top.
double horizon_height(const Camera& camera, const Eigen::Vector3d& normal,
                      const Eigen::Matrix4f& to_clip);

/// Middle and half edges of what is not zero in a square picture, its edges being -1 and 1, with a
/// pixel more on every side; half edges 0 where everything is zero.
Eigen::Vector4f covered(const std::vector<std::uint8_t>& image, int size);

/// Two passes of a box of 2 radius + 1 along rows and columns of a square
/// picture, in place.
void blur(std::vector<std::uint8_t>& image, int size, int radius);

}  // namespace ayumi
