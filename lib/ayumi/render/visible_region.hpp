#pragma once
// Which part of a picture has edges to be smoothed, and which part is ground alone. Pixels and rows
// are counted from the bottom, as OpenGL does.

#include <Eigen/Geometry>
#include <array>

#include "ayumi/render/camera.hpp"
#include "ayumi/render/ground_plane.hpp"

namespace ayumi {

/// Part of a picture; empty where no edge is longer than 0.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;  ///< [pixel]
};

/// The pixels that boxes and points may fall on. What reaches behind the camera takes the whole
/// picture.
class VisibleRegion {
 public:
  VisibleRegion(const Eigen::Matrix4f& view_projection, int width, int height);
  void add(const Eigen::Vector3d& point);
  void add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose);
  /// With two pixels more on every side.
  PixelBox pixels() const;

 private:
  Eigen::Matrix4d view_projection_;
  int width_, height_;
  Eigen::AlignedBox2d seen_;  // -1..1 over the picture
};

/// The picture without `inner`, as boxes beside each other.
std::array<PixelBox, 4> around(const PixelBox& inner, int width, int height);

/// Height up to which a picture shows nothing but the square of the plane with this middle (plane
/// coordinates) and half edge [m]: -1 its bottom, 1 its top.
double ground_height(const Camera& camera, double aspect, const GroundRectangle& plane,
                     const Eigen::Vector2d& center, double reach);

}  // namespace ayumi
