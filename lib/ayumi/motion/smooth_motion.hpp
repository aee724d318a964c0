#pragma once
// Replaces parts of a sampled motion by smooth curves, where noise, rounded angles or jumps make
// its accelerations useless.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The series in which base and joints follow, within each window, the uniform cubic splines that
/// are nearest to them (least squares over the samples of the window). At its ends, such a curve
/// has the place, speed and acceleration that the samples there have, noise included; at the ends
/// of the motion, it rests at the place of the motion. In the window and one sample beside it,
/// velocities and accelerations are computed again. COG, ZMP, f_z and contacts do not change.
/// Windows are in order and do not overlap; those shorter than eight steps change nothing.
CommandSeries smoothed(const CommandSeries& series, const std::vector<SmoothWindow>& windows);

}  // namespace ayumi
