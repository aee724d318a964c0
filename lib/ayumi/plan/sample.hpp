#pragma once
// Pattern -> CommandSeries: the author's keys are interpolated, and the other quantities are
// solved. ZMP keys without COG keys: the bounded solution of (14)(15), corrected so that the ZMP of
// the full model meets the keys. Feet and COG: legs and base by inverse kinematics. Joint keys or a
// table for the legs: base from the planned support foot, COG from the posture. COG, ZMP and f_z
// without keys: from the full model.

#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct SampleOptions {
  double dt = 0.001;  ///< [s]
  int threads = 0;    ///< 0: all cores; results do not depend on it
};

/// Throws Error(bad_pattern) with file, place and remedy: an unknown joint, times that do not
/// increase, a foot out of reach (foot, time, missing millimetres), a phase without a supporting
/// foot, ...
CommandSeries sample(const RobotModel& model, const Pattern& pattern,
                     const SampleOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
