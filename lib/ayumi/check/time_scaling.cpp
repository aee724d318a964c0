#include "ayumi/check/time_scaling.hpp"

#include <algorithm>

#include "ayumi/check/influence_interval.hpp"

namespace ayumi {

namespace {

// Slowest pace that is tried. Chosen: a motion that would need less than a twentieth of its pace is
// not called too fast. No measured case changes between half and twice the value (constants.md).
constexpr double kSlowestPace = 0.05;
// Ratio of each pace to the one before. Chosen: commands of ZMP and f_z agree with the motion
// within their tolerances in a band of paces 6 % wide, so that steps of 3 % cannot miss it. No
// measured case changes between half and twice the value (constants.md).
constexpr double kPaceStep = 0.97;
// The same ratio for a mean over the thermal window. Chosen: there, no command bounds the pace from
// below, so that larger steps cannot miss anything.
constexpr double kCoarsePaceStep = 0.85;

bool holds_at(JudgedMotion& motion, const Violation& v, double pace) {
  const auto holds = spec_of(v.kind).holds_at;
  return holds && holds(motion, v, pace);
}

}  // namespace

bool broken_by_jump(const JudgedMotion& motion, int sample) {
  const auto begin = motion.rough.begin();
  return std::any_of(begin + std::max(0, sample - kDifferenceReach),
                     begin + std::min(motion.count(), sample + kDifferenceReach + 1),
                     [](char rough) { return rough; });
}

bool slower_pace_removes(JudgedMotion& motion, const Violation& cause, const Violation& effect) {
  const bool flies =
      effect.kind == FindingKind::ballistic || effect.kind == FindingKind::angular_momentum;
  if (!flies && broken_by_jump(motion, effect.sample))
    return spec_of(effect.kind).limit_class != LimitClass::rate;
  const double step = effect.kind == FindingKind::continuous_torque ? kCoarsePaceStep : kPaceStep;
  for (double pace = step; pace > kSlowestPace; pace *= step)
    if (holds_at(motion, cause, pace) && holds_at(motion, effect, pace)) return true;
  return false;
}

}  // namespace ayumi
