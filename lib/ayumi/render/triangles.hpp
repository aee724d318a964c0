#pragma once
// Coloured triangles as the renderer takes them, and the surfaces made of them: the shapes of links
// and the marks of overlays. Closed surfaces are wound counter-clockwise seen from outside.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

struct RenderVertex {
  Eigen::Vector3f position;           ///< [m]
  Eigen::Vector3f normal;             ///< unit; zero: not lit, the colour as it is
  std::array<std::uint8_t, 4> color;  ///< sRGB and alpha
  /// Place in a texture, v upwards.
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
};

struct Triangles {
  std::vector<RenderVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle
};

/// A part of `indices`.
struct IndexRange {
  int count = 0;
  size_t first = 0;
};

/// Adds `part` to `target`, moved and turned by `pose`.
void append(Triangles& target, const Triangles& part,
            const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// The same triangles, vertices that are alike to the bit being one.
Triangles welded(const Triangles& surface);

/// Surface of a box, sphere, cylinder or capsule in its own frame. Throws Error(internal) for a
/// mesh.
Triangles tessellate(const Shape& primitive, const Eigen::Vector4f& color);

/// One part of a mesh. Normals that are missing or not finite are taken from the faces.
Triangles tessellate(const MeshPart& part, const Eigen::Vector4f& color);

enum class SurfaceKind { closed, open };

/// Whether every edge joins two triangles (vertices compared by position). A closed surface that is
/// inside out is turned; normals against the winding are turned too.
SurfaceKind orient(Triangles& surface);

/// Axis-aligned bounds of points; empty while `lower` exceeds `upper`.
Eigen::AlignedBox3d bounds(const Triangles& surface);

/// Marks of overlays. Colours sRGB and alpha, lengths [m], world frame.
void add_sphere(Triangles& target, const Eigen::Vector3d& center, double radius,
                const Eigen::Vector4f& color);
/// Shaft and head; nothing when shorter than a tenth of a millimetre.
void add_arrow(Triangles& target, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               double radius, const Eigen::Vector4f& color);
void add_rod(Triangles& target, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             double radius, const Eigen::Vector4f& color);
/// Flat ring (inner = 0: disc) seen from the side `normal` points to.
void add_ring(Triangles& target, const Eigen::Vector3d& center, const Eigen::Vector3d& normal,
              double inner, double outer, const Eigen::Vector4f& color);
/// Flat band along a polyline, facing `normal`; `color_at` per point; closed: back to the start.
void add_band(Triangles& target, const std::vector<Eigen::Vector3d>& points,
              const std::vector<Eigen::Vector4f>& color_at, const Eigen::Vector3d& normal,
              double width, bool closed = false);
/// Convex polygon, counter-clockwise seen from `normal`.
void add_polygon(Triangles& target, const std::vector<Eigen::Vector3d>& points,
                 const Eigen::Vector4f& color);

}  // namespace ayumi
