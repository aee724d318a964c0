#pragma once
// Time scaling shows whether a motion violates its limits because it is too fast. The same path is
// played more slowly: rates are multiplied by a pace, accelerations by the square of the pace.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Whether the path is discontinuous near this sample, so that rates from differences make the
/// demand too large and time scaling cannot help.
bool broken_by_jump(const JudgedMotion& motion, int sample);

/// Whether one pace removes both violations. If the path is discontinuous near the effect, no pace
/// removes them. In this case the effect is attributed to the speed, unless the effect is the
/// discontinuity itself.
bool slower_pace_removes(JudgedMotion& motion, const Violation& cause, const Violation& effect);

}  // namespace ayumi
