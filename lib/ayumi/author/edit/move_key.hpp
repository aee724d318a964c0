#pragma once
// Moves the keys of a motion over the ground.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Moves the values of a keyframe that are given in the world, except poses of feet.
void move_key(const Eigen::Isometry3d& shift, Keyframe& key);

/// Throws Error(bad_pattern) if `shift` turns the pattern and only one of COG x and COG y has keys,
/// because a turn mixes both.
void require_moved_together(const Eigen::Isometry3d& shift, const Pattern& pattern);

}  // namespace ayumi
