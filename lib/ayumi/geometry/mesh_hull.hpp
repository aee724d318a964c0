#pragma once
// The outer vertices of a mesh, which can touch other bodies, and the faces of their convex hull.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// All vertices of a mesh with at most 32 of them; for a larger mesh, those that are farthest out
/// in 90 directions on the sphere. They are sorted and have no duplicates.
std::vector<Eigen::Vector3d> outer_vertices(const TriangleMesh& mesh);

struct HullFace {
  Eigen::Vector3d normal;  ///< normal that points outwards
  /// Corners, anticlockwise as seen from outside, at most 16.
  std::vector<Eigen::Vector3d> corners;
};

/// The faces of the convex hull of up to a few hundred points, with coplanar triangles merged; none
/// if the points lie in a plane. The time is proportional to the cube of the number of points.
std::vector<HullFace> hull_faces(const std::vector<Eigen::Vector3d>& points);

}  // namespace ayumi
