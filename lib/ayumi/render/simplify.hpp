#pragma once
// Draws the same look with fewer triangles: vertices that share a cell of a grid become one.

#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// The number of triangles of all bodies.
size_t triangle_count(const std::vector<BodySurface>& surface);

/// Simplifies until at most `max_triangles` are left. It takes the finest grid that achieves this
/// from a row of grids, each 1.25 times as coarse as the one before. Outlines move by at most the
/// diagonal of a cell. Returns the edge of the cells [m]; 0 if nothing was changed. Closed surfaces
/// stay closed.
double simplify(std::vector<BodySurface>& surface, size_t max_triangles);

}  // namespace ayumi
