#pragma once
// Makes a CommandSeries from a Pattern: the author's keys are interpolated, and the other
// quantities are solved. If there are ZMP keys without COG keys, the COG is the bounded solution of
// (14)(15), corrected so that the ZMP of the full model meets the keys. If feet and COG are given,
// legs and base follow by inverse kinematics. If joint keys or a table move the legs, the base
// follows from the planned support foot, and the COG from the posture. COG, ZMP and f_z without
// keys come from the full model.

#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct SampleOptions {
  double dt = 0.001;  ///< [s]
  int threads = 0;    ///< number of threads; 0: all cores; results do not depend on it
};

/// Throws Error(bad_pattern) with file, place and remedy, for example for an unknown joint, for
/// times that do not increase, for a foot out of reach (with foot, time and missing millimetres),
/// or for a phase without a supporting foot.
CommandSeries sample(const RobotModel& model, const Pattern& pattern,
                     const SampleOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
