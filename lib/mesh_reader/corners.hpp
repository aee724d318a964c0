#pragma once
// Normals where a mesh has none, and one vertex in place of many that are alike.

#include "ayumi/geometry/shape.hpp"

namespace ayumi::mesh_reader {

/// Corners with a normal of zero get the mean of the facets around their place that are turned from
/// their own by less than a crease; edges stay edges. Vertices with the same place, normal and
/// texture coordinates become one.
void finish_corners(MeshPart& part);

}  // namespace ayumi::mesh_reader
