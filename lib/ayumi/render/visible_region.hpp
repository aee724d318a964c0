#pragma once
// Which part of a picture something stands in before the ground. Pixels and rows are counted from
// the bottom, as OpenGL does.

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ayumi/render/camera.hpp"

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

/// Which parts of a box of the picture have anything in them, by tiles of a few pixels.
class CoveredTiles {
 public:
  CoveredTiles(const Eigen::Matrix4f& view_projection, int width, int height, const PixelBox& box);
  /// The smallest convex body that holds these points.
  void add(std::span<const Eigen::Vector3d> points);
  void add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose);
  /// Beside and above each other, within the box.
  std::vector<PixelBox> runs() const;

 private:
  Eigen::Matrix4d view_projection_;
  int width_, height_;
  PixelBox box_;
  int columns_, rows_;
  std::vector<bool> covered_;  // by rows
};

}  // namespace ayumi
