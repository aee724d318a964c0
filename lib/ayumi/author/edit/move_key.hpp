#pragma once
// Keys of a motion that is moved over the ground.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Moves what a keyframe gives in the world, except poses of feet.
void move_key(const Eigen::Isometry3d& shift, Keyframe& key);

/// Throws Error(bad_pattern) where a turn would mix a key of COG x or y with one that is missing.
void require_moved_together(const Eigen::Isometry3d& shift, const Pattern& pattern);

}  // namespace ayumi
