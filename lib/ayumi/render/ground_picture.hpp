#pragma once
// Ground, sky and the robot's shadow as a picture, row by row. Each pixel is computed from its
// place alone, without triangles. All colours are sRGB.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "ayumi/render/ground_plane.hpp"
#include "ayumi/render/image.hpp"
#include "ayumi/render/visible_region.hpp"

namespace ayumi {

/// Half the edge of the visible square of the plane, in distances of the camera from its target.
constexpr double kPlaneReach = 30;

/// The middle of the visible square of the plane, in coordinates of the plane: the point of the
/// plane at the camera's target.
Eigen::Vector2d middle_of_plane(const Camera& camera, const GroundRectangle& plane);

/// Pixels of a row; the end is excluded.
struct PixelSpan {
  int begin = 0, end = 0;
};

/// The robot's shadow as coverage of a square of the plane.
struct ShadowPicture {
  static constexpr int kSize = 256;  ///< number of pixels of an edge
  /// Coverage of kSize^2 pixels, along u then v of the plane; empty without shadow.
  std::vector<std::uint8_t> cover;
  Eigen::Vector4f dark = {0, 0, 0, 0};  ///< dark part of the square, as covered() returns it

  /// The coverage, interpolated between pixels. Both arguments go from 0 to 1 over the square.
  /// Outside the square, the value at its edge is used.
  float at(float along_u, float along_v) const;
};

/// A square of the plane around the middle of the picture, as a camera sees it.
class GroundPicture {
 public:
  /// `to_clip` belongs to the camera. `hole` is in the plane's coordinates and empty if there is
  /// none. Without `shown`, everything is sky.
  GroundPicture(const Camera& camera, const Eigen::Matrix4d& to_clip, int width, int height,
                const GroundRectangle& plane, const Eigen::AlignedBox2d& hole, bool shown);

  /// The parts of a row that show the plane: to the left and to the right of the hole.
  std::array<PixelSpan, 2> plane_in_row(int y) const;
  void draw(const ShadowPicture& shadow, Image& image) const;

 private:
  /// (a, b, c) of a line: the pixels with a x + b y + c >= 0 are used.
  using Line = Eigen::Vector3d;
  int width_, height_;
  GroundRectangle plane_;
  bool shown_ = false;
  double horizon_ = 0;
  double fade_ = 1;                 // distance at which the ground becomes the horizon's colour [m]
  Eigen::Vector2d middle_, whole_;  // middle of the square; a point with whole metres near it
  Eigen::Matrix3d place_;           // maps a pixel (x, y, 1) to (u, v, 1) over the distance
  std::vector<Line> seen_, hole_;

  PixelSpan span(const std::vector<Line>& lines, int y) const;
  void draw_shadow(const ShadowPicture& shadow, Image& image) const;
};

/// Lays a part of a picture over the image. It has four bytes per pixel and starts with its bottom
/// row. Red, green and blue are multiplied by the fourth byte, which says how much of the pixel
/// they cover. Each row begins `stride` pixels after the row below.
void lay_pixels_over(const std::uint8_t* rgba, int stride, const PixelBox& box, Image& image);

}  // namespace ayumi
