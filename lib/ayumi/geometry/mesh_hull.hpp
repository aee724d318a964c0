#pragma once
// The outer vertices of a mesh, which can touch other bodies, and the faces of their convex hull.

#include <Eigen/Geometry>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// The smallest box around all vertices, in the axes of the mesh; a point at the origin if there
/// are no vertices.
Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh);

/// All vertices of a mesh with at most 32 of them; for a larger mesh, those that are farthest out
/// in 90 directions on the sphere. They are sorted and have no duplicates.
std::vector<Eigen::Vector3d> outer_vertices(const TriangleMesh& mesh);

struct HullFace {
  Eigen::Vector3d normal;  ///< normal that points outwards
  /// Corners, anticlockwise as seen from outside, at most 16.
  std::vector<Eigen::Vector3d> corners;
};

/// The faces of the convex hull of up to a few hundred points, with coplanar triangles merged; none
/// if the points lie in a plane. At worst, the time is proportional to the cube of the number of
/// points.
std::vector<HullFace> hull_faces(const std::vector<Eigen::Vector3d>& points);

/// The part of a mesh that can touch other bodies.
struct MeshHull {
  MeshHull() = default;
  explicit MeshHull(const TriangleMesh& mesh);

  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of the bounding box [m]
  std::vector<Eigen::Vector3d> vertices;             ///< outer_vertices() [m]
  std::vector<Eigen::Vector3d> points;               ///< the vertices relative to the centre [m]
  std::vector<HullFace> faces;                       ///< hull_faces() of the points
};

}  // namespace ayumi
