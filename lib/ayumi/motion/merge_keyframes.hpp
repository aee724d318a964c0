#pragma once
// Two keyframes at one time as one.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// `key` also sets what `later` sets; where both name the same track, `later` counts.
void merge(Keyframe& key, const Keyframe& later);

}  // namespace ayumi
