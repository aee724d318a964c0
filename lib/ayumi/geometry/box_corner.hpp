#pragma once
// The corners of a box.

#include <Eigen/Core>

namespace ayumi {

/// Corner i (0 to 7) of a box with these half lengths [m], relative to its centre. Bit k of `i`
/// gives the side along axis k.
inline Eigen::Vector3d box_corner(const Eigen::Vector3d& half, int i) {
  return {i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z()};
}

}  // namespace ayumi
