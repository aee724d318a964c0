#pragma once
// What a motion does to its angular momentum in flight, as the check judges it.

#include <functional>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// In flight, and not so near its edges that the rates mix it with support; false outside the
/// series.
bool flies_freely(const CommandSeries& series, int sample);

/// Mean of the moments of the samples around one [N m], as far as they fly freely; 0 where none
/// does. `moment`: of one sample.
Eigen::Vector3d mean_flight_moment(const CommandSeries& series, int sample,
                                   const std::function<Eigen::Vector3d(int sample)>& moment);

}  // namespace ayumi
