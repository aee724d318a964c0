#pragma once
// Fewer triangles for the same look: vertices that share a cell of a grid become one.

#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// Triangles of all bodies.
size_t triangle_count(const std::vector<BodySurface>& surface);

/// Simplifies until at most `max_triangles` are left, with the finest of a row of grids (each 1.25
/// times as coarse as the last) that does it. Outlines move by at most the diagonal of a cell.
/// Returns the edge of the cells [m]; 0 when nothing was changed. Closed surfaces stay closed.
double simplify(std::vector<BodySurface>& surface, size_t max_triangles);

}  // namespace ayumi
