#pragma once
// Removes what no camera outside a robot can see: triangles within a convex part of the same body,
// such as the end of a tube in the housing of a joint.

#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// Leaves out triangles whose three corners are inside one convex, opaque, closed part of the same
/// body's closed surface. Such a triangle is inside as a whole, so that pictures stay as they are.
/// Surfaces with holes, and everything inside parts that are not convex, stay.
void leave_out_hidden(std::vector<BodySurface>& robot);

}  // namespace ayumi
