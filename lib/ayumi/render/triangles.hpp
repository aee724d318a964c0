#pragma once
// Coloured triangles as the renderer takes them, and the surfaces made of them: the shapes of links
// and the marks of overlays. Closed surfaces are wound counter-clockwise as seen from outside.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

struct RenderVertex {
  Eigen::Vector3f position;  ///< position [m]
  /// Unit normal; if it is zero, the surface is not lit and shows its plain colour.
  Eigen::Vector3f normal;
  std::array<std::uint8_t, 4> color;  ///< sRGB and alpha
  /// Place in a texture, in which v points upwards.
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
};

struct Triangles {
  std::vector<RenderVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three indices per triangle
};

/// A part of `indices`.
struct IndexRange {
  int count = 0;
  size_t first = 0;
};

/// Adds `part` to `target`, moved and turned by `pose`.
void append(Triangles& target, const Triangles& part,
            const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// The triangles of `surface`, in which vertices that are equal to the bit have become one.
Triangles welded(const Triangles& surface);

/// The surface of a box, sphere, cylinder or capsule in its own frame. Throws Error(internal) for a
/// mesh.
Triangles tessellate(const Shape& primitive, const Eigen::Vector4f& color);

/// The surface of one part of a mesh. Normals that are missing or not finite are taken from the
/// faces.
Triangles tessellate(const MeshPart& part, const Eigen::Vector4f& color);

enum class SurfaceKind { closed, open };

/// Finds out whether every edge joins two triangles, where vertices are compared by position. A
/// closed surface that is inside out is turned; normals against the winding are turned too.
SurfaceKind orient(Triangles& surface);

/// The axis-aligned bounds of the points; empty as long as `lower` exceeds `upper`.
Eigen::AlignedBox3d bounds(const Triangles& surface);

/// The following functions add marks of overlays. Colours are sRGB and alpha, lengths are in
/// metres, and places are in the world frame.
void add_sphere(Triangles& target, const Eigen::Vector3d& center, double radius,
                const Eigen::Vector4f& color);
/// An arrow of shaft and head. Nothing is added if it is shorter than a tenth of a millimetre.
void add_arrow(Triangles& target, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               double radius, const Eigen::Vector4f& color);
void add_rod(Triangles& target, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             double radius, const Eigen::Vector4f& color);
/// A flat ring (a disc if inner = 0), seen from the side to which `normal` points.
void add_ring(Triangles& target, const Eigen::Vector3d& center, const Eigen::Vector3d& normal,
              double inner, double outer, const Eigen::Vector4f& color);
/// A flat band along a polyline, whose visible side is that of `normal`. `color_at` gives the
/// colour of each point; if `closed`, the band returns to the start.
void add_band(Triangles& target, const std::vector<Eigen::Vector3d>& points,
              const std::vector<Eigen::Vector4f>& color_at, const Eigen::Vector3d& normal,
              double width, bool closed = false);
/// A convex polygon, counter-clockwise as seen from `normal`.
void add_polygon(Triangles& target, const std::vector<Eigen::Vector3d>& points,
                 const Eigen::Vector4f& color);

}  // namespace ayumi
