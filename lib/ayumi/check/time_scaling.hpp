#pragma once
// Time scaling: is a motion too fast where it violates its limits? The same path is played slower:
// rates times a pace, accelerations times its square.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Whether the demand near this sample is broken by differences over a jump, so that no pace mends
/// it.
bool broken_by_jump(const JudgedMotion& motion, int sample);

/// Whether there is one pace at which both violations are gone. Where the demand is broken by a
/// jump, no pace removes it: then the violation is attributed to speed, unless it is that jump.
bool slower_pace_removes(JudgedMotion& motion, const Violation& cause, const Violation& effect);

}  // namespace ayumi
