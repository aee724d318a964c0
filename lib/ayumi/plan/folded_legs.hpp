#pragma once
// Tells whether legs that do not reach the ground are folded rather than straight. If they are
// folded, the COG has to be higher and not lower.

#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

// Below this share of the COG height at home, legs are folded. Chosen: the deepest squat of HOAP-1
// is at 0.6 and walks are above 0.9. With half of this share, a COG would be called too high
// although no leg can fold further; with twice, legs that are nearly straight would count as
// folded.
inline constexpr double kFoldedShare = 0.7;

/// COG height in the home posture of a pattern [m].
inline double home_cog_height(const RobotModel& model, Pattern pattern) {
  pattern.cog_height = 0;
  return default_cog_height(model, pattern);
}

/// Whether legs are folded at this height of the COG above the soles [m].
inline bool legs_are_folded(const RobotModel& model, const Pattern& pattern, double cog_height) {
  return cog_height < kFoldedShare * home_cog_height(model, pattern);
}

}  // namespace ayumi
