#pragma once
// A ZMP for a plan whose COG should move to the side as little as possible. Legs without the roll
// of an ankle carry the hips over the feet, so that only the lean of the trunk moves the COG aside.

#include <array>
#include <optional>

#include "ayumi/base/progress.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The ZMP in the world [m] with which the COG of the linear pendulum stays nearest to the middle
/// of the soles, across their heading. It keeps a distance from the edges of the support. Along the
/// heading, it is near the ZMP of `plan`. Soles, supports and the height of the COG are those of
/// `plan`. It changes smoothly over about `smooth` [s]; with a longer time, the COG moves farther.
/// Empty if the plan has a flight, or if no such ZMP was found.
std::optional<std::array<Track, 3>> zmp_of_least_sway(const RobotModel& model,
                                                      const CommandSeries& plan, double smooth,
                                                      const Progress& progress = {});

}  // namespace ayumi
