#pragma once
// The part of a picture in which something stands in front of the ground. Pixels and rows are
// counted from the bottom, as in OpenGL.

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ayumi/render/camera.hpp"

namespace ayumi {

/// A part of a picture; it is empty if its width or height is 0.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;  ///< corner and size [pixel]
};

/// The pixels onto which boxes and points may fall. If something reaches behind the camera, it is
/// the whole picture.
class VisibleRegion {
 public:
  VisibleRegion(const Eigen::Matrix4f& view_projection, int width, int height);
  void add(const Eigen::Vector3d& point);
  void add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose);
  /// The region with two pixels more on every side.
  PixelBox pixels() const;

 private:
  Eigen::Matrix4d view_projection_;
  int width_, height_;
  Eigen::AlignedBox2d seen_;  // region in coordinates of -1..1 over the picture
};

/// The parts of a box of the picture that have anything in them, by tiles of a few pixels.
class CoveredTiles {
 public:
  CoveredTiles(const Eigen::Matrix4f& view_projection, int width, int height, const PixelBox& box);
  /// Adds the smallest convex body that contains these points.
  void add(std::span<const Eigen::Vector3d> points);
  void add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose);
  /// The covered tiles as boxes beside and above each other, within the box.
  std::vector<PixelBox> runs() const;

 private:
  Eigen::Matrix4d view_projection_;
  int width_, height_;
  PixelBox box_;
  int columns_, rows_;
  std::vector<bool> covered_;  // covered tiles, row by row
};

}  // namespace ayumi
