#pragma once
// A goal of VIIP as a keyed motion, which the check can judge. Plain data.

#include <string>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The motion that a goal commands, as keys from rest to rest: a displacement of the COG, a walk
/// with steps of the same length and time, or a jump. VIIP moves its footholds with the robot; the
/// footholds here are the nominal ones.
struct KeyedGoal {
  std::string place;     ///< the goal in words, such as "VIIP steps at 0.50 s"
  std::string obstacle;  ///< reason why no such motion exists; empty if it exists
  CommandSeries motion;  ///< its time begins at 0
};

}  // namespace ayumi
