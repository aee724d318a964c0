#pragma once
// Time scaling: is a motion too fast where it violates its limits? The same path is played slower:
// rates times a pace, accelerations times its square.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Whether differences across a jump spoil the demand near this sample, so that time scaling cannot
/// help.
bool broken_by_jump(const JudgedMotion& motion, int sample);

/// Whether one pace removes both violations. Where a jump spoils the demand, no pace removes it:
/// then the violation is attributed to the speed, unless it is that jump itself.
bool slower_pace_removes(JudgedMotion& motion, const Violation& cause, const Violation& effect);

}  // namespace ayumi
