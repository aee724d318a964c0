#pragma once
// A goal of VIIP as a motion with keys, which the check can judge. Plain data.

#include <string>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// What a goal asks for, as keys of its own, from rest to rest: the COG's way, a walk whose steps
/// are as long and as quick, the jump. Footholds of VIIP move with the robot; these are its nominal
/// ones.
struct KeyedGoal {
  std::string place;     ///< "VIIP steps at 0.50 s"
  std::string obstacle;  ///< why no such motion exists; "" where it does
  CommandSeries motion;  ///< its time begins at 0
};

}  // namespace ayumi
