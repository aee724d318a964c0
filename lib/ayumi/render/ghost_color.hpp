#pragma once
// The colour of a ghost: a colour that the robot does not have. It is the same in clips and on
// pages.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ayumi/render/robot_surface.hpp"

namespace ayumi {

/// Colours of a ghost, sRGB.
struct GhostColors {
  Eigen::Vector3f beside_robot = Eigen::Vector3f::Zero();
  Eigen::Vector3f beside_heat =
      Eigen::Vector3f::Zero();  ///< the colour if amber and red also mark joints near their limits
};

/// The colour with that hue, among those that ghosts have, which is farthest from the hues of the
/// robot. Each triangle counts by its area and its saturation. For a grey robot it is orange.
GhostColors ghost_colors(const std::vector<BodySurface>& robot);

/// The colour as text, such as "#ed730d".
std::string hex_text(const Eigen::Vector3f& srgb);

}  // namespace ayumi
