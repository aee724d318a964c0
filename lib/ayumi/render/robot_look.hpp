#pragma once
// The surface of a robot for all pictures. It is made from the meshes once, for any number of
// clips, snapshots and pages.

#include <memory>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/render/ghost_color.hpp"
#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

struct RobotLook {
  /// Like robot_surface(), but with fewer triangles if there are too many.
  std::vector<BodySurface> surface;
  size_t triangles = 0;  ///< number of triangles of the robot's own meshes
  double moved = 0;      ///< approximate distance of the surface from the meshes [m]; 0 if equal
  GhostColors ghost;     ///< ghost_colors() of the robot's own meshes
};

/// The look of a robot. It depends on the robot alone, so that all pictures of a robot show the
/// same surface.
std::shared_ptr<const RobotLook> robot_look(const RobotModel& model, const Progress& progress = {});

/// Largest distance between a thinned surface and the original surface of the robot [pixel].
/// Chosen: the four samples of a pixel are a quarter of a pixel apart. With half of the value, more
/// triangles of round parts stay; with twice, their outlines have corners of half a pixel.
inline constexpr double kThinned = 0.3;

/// Thins, first by `tolerance` [m] and then by multiples of it up to four, until at most `most`
/// triangles are left. Returns the last tolerance; more triangles may be left then.
double thin_to(std::vector<BodySurface>& surface, double tolerance, size_t most,
               const Progress& progress = {});

/// A text such as "the robot has 500000 triangles, but it is drawn with 4000 triangles. This
/// simplification moves the surface by about 2 mm".
std::string words_of(const RobotLook& look, size_t drawn, double moved);

}  // namespace ayumi
