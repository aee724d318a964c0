#pragma once
// What of a mesh can touch: the vertices farthest out, and the faces of their convex hull.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// All vertices of a mesh of at most 32; of a larger one those that are farthest out in 90
/// directions spread over the sphere. Sorted, none twice.
std::vector<Eigen::Vector3d> outer_vertices(const TriangleMesh& mesh);

struct HullFace {
  Eigen::Vector3d normal;                ///< outwards
  std::vector<Eigen::Vector3d> corners;  ///< anticlockwise seen from outside, at most 16
};

/// Faces of the convex hull of up to some hundred points, coplanar ones in one; none where the
/// points lie in a plane. Time goes with the cube of the number of points.
std::vector<HullFace> hull_faces(const std::vector<Eigen::Vector3d>& points);

}  // namespace ayumi
