#pragma once
// Draws fewer triangles where nobody sees the difference: vertices move onto neighbours as long as
// the surface moves, on average, by less than a fraction of a pixel.

#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// `surface` with fewer triangles, which lie about `tolerance` [m] from the original ones. A vertex
/// only moves along an edge onto its other end. Outlines of open surfaces and borders of colours
/// also stay near their original lines; normals and colours of the corners that stay are kept;
/// closed surfaces stay closed. Pictures on surfaces are not touched. `progress` is called in every
/// round. `done` is the tolerance of the last call, with which the surface was made; rounds up to
/// it are left out. The method is that of Garland and Heckbert (1997), with the squared distances
/// as a mean over the area that a vertex stands for.
Triangles thinned(const Triangles& surface, double tolerance, const Progress& progress = {},
                  double done = 0);
void thin(std::vector<BodySurface>& surface, double tolerance, const Progress& progress = {},
          double done = 0);

}  // namespace ayumi
