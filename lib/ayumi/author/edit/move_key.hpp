#pragma once
// Moves the keys of a motion over the ground.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Moves the values of a keyframe that are given in the world, except poses of feet.
void move_key(const Eigen::Isometry3d& shift, Keyframe& key);

/// Throws Error(bad_pattern) where a turn would mix a key of COG x or y with one that is missing.
void require_moved_together(const Eigen::Isometry3d& shift, const Pattern& pattern);

}  // namespace ayumi
