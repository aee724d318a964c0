#pragma once
// The extent of shapes, accurate enough to compare sizes and to find undersides.

#include <Eigen/Core>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Points whose convex hull is the shape, in the shape's frame: 16 points per ring of a round
/// shape, the vertices of a mesh; none for a mesh that is not loaded.
std::vector<Eigen::Vector3d> outline(const Shape& shape);

}  // namespace ayumi
