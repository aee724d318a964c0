#pragma once
// A place as a key writes it.

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi {

/// "[0.1, -0.039, 0]" in metres, rounded to the micrometre, so that a key with these numbers is at
/// this place; a zero has no minus sign.
inline std::string place_text(const Eigen::Vector3d& place) {
  const auto number = [](double value) { return text::exact(std::round(1e6 * value) / 1e6 + 0.0); };
  return "[" + number(place.x()) + ", " + number(place.y()) + ", " + number(place.z()) + "]";
}

}  // namespace ayumi
