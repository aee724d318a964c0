#pragma once
// Merges two keyframes at the same time into one.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Sets in `key` also what `later` sets. If both name the same track, `later` counts.
void merge(Keyframe& key, const Keyframe& later);

}  // namespace ayumi
