#pragma once
// The colour of a ghost: one that the robot does not have, the same in clips and on pages.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// sRGB.
struct GhostColors {
  Eigen::Vector3f beside_robot = Eigen::Vector3f::Zero();
  Eigen::Vector3f beside_heat =
      Eigen::Vector3f::Zero();  ///< also beside the amber and red of joints near their limits
};

/// Of the hues that ghosts have, the one furthest from those of the robot: each triangle counts by
/// its area and its saturation. Orange beside a grey robot.
GhostColors ghost_colors(const std::vector<BodySurface>& robot);

/// "#ed730d".
std::string hex_text(const Eigen::Vector3f& srgb);

}  // namespace ayumi
