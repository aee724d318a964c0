#pragma once
// Makes normals if a mesh has none, and joins equal vertices.

#include "ayumi/geometry/shape.hpp"

namespace ayumi::mesh_reader {

/// Corners with a normal of zero get the mean normal of the facets around their place that are
/// turned against their own facet by less than a crease; edges stay edges. Vertices with the same
/// place, normal and texture coordinates become one.
void finish_corners(MeshPart& part);

}  // namespace ayumi::mesh_reader
