#pragma once
// The change of the angular momentum of a motion in flight, as the check judges it.

#include <functional>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Whether a sample is in flight and so far from its beginning and end that its rates do not mix
/// flight and support. False outside the series.
bool flies_freely(const CommandSeries& series, int sample);

/// The mean of the moments of the samples around one sample that are in free flight [N m]; 0 if
/// there are none. `moment` returns the moment of one sample.
Eigen::Vector3d mean_flight_moment(const CommandSeries& series, int sample,
                                   const std::function<Eigen::Vector3d(int sample)>& moment);

}  // namespace ayumi
