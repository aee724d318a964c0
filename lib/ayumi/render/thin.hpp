#pragma once
// Draws fewer triangles where nobody sees the difference: vertices move onto neighbours as long as
// the surface moves, on average, by less than a fraction of a pixel.

#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// `surface` with fewer triangles, which lie about `tolerance` [m] from the original ones. A vertex
/// only moves along an edge onto its other end. Outlines of open surfaces and borders of colours
/// also stay near their original lines. Corners that stay keep their normals and colours, and
/// closed surfaces stay closed. Pictures on surfaces are not touched. `progress` is called in every
/// round. If the surface was made by an earlier call, `done` is the tolerance of that call; rounds
/// up to this tolerance are left out. The method is that of Garland and Heckbert (1997); a squared
/// distance is the mean over the area that belongs to a vertex.
Triangles thinned(const Triangles& surface, double tolerance, const Progress& progress = {},
                  double done = 0);
void thin(std::vector<BodySurface>& surface, double tolerance, const Progress& progress = {},
          double done = 0);

}  // namespace ayumi
