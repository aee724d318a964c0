#pragma once
// The extent of shapes, good enough to compare sizes and to find undersides.

#include <Eigen/Core>
#include <vector>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// Points whose convex hull is the shape (round ones by 16 corners a ring), in the shape's own
/// frame; the vertices of a loaded mesh, nothing for one that is not loaded.
std::vector<Eigen::Vector3d> outline(const Shape& shape);

}  // namespace ayumi
