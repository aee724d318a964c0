#include "loop_words.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi::app {

std::string gap_words(const LoopGap& gap) {
  return "feet " + text::fixed(1e3 * gap.feet, 2) + " mm, base " + text::fixed(1e3 * gap.base, 2) +
         " mm, posture " + text::fixed(gap.posture * 180 / M_PI, 2) + " deg" +
         (gap.joint.empty() ? "" : " (" + gap.joint + ")") + ", joint speeds " +
         text::fixed(gap.rate * 180 / M_PI, 2) + " deg/s";
}

std::string gap_and_limits(const LoopGap& gap) {
  return gap_words(gap) + " (limits: " + gap_words(largest_loop_gap()) + ")";
}

nlohmann::ordered_json gap_json(const LoopGap& gap) {
  return {{"feet_m", gap.feet},
          {"base_m", gap.base},
          {"posture_rad", gap.posture},
          {"rate_rad_per_s", gap.rate},
          {"joint", gap.joint}};
}

}  // namespace ayumi::app
