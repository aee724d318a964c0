#pragma once
// The colour of a ghost: one that the robot does not have, the same in clips and on pages.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// Which colours are drawn beside the ghost.
enum class BesideGhost {
  robot,      ///< those of the robot
  robot_heat  ///< those, and the amber and red of joints near their limits
};

/// sRGB. Of the hues that ghosts have, the one furthest from those of the robot: each triangle
/// counts by its area and its saturation. Orange beside a grey robot.
Eigen::Vector3f ghost_color(const std::vector<BodySurface>& robot, BesideGhost beside);

/// "#ed730d".
std::string hex_text(const Eigen::Vector3f& srgb);

}  // namespace ayumi
