#pragma once
// The extent of shapes, with enough accuracy to compare sizes and to find undersides.

#include <Eigen/Core>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Points whose convex hull is the shape, in the shape's frame. A round shape has 16 points per
/// ring, and a mesh has its vertices. A mesh that is not loaded has no points.
std::vector<Eigen::Vector3d> outline(const Shape& shape);

}  // namespace ayumi
