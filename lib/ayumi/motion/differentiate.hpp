#pragma once
// Rates of a sampled motion, and the ground wrench the full model needs for it.

#include <vector>

#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Fills velocities and accelerations of base, joints and COG by central differences of fourth
/// order. `rest_ends`: the motion is at rest before its first and after its last sample; otherwise
/// it goes on as a cubic.
void fill_rates(std::vector<CommandSample>& samples, double dt, bool rest_ends);

/// ZMP at the height of `sample.zmp` and force that the full model needs. Below 5 % of the weight
/// the ZMP stays under the base (flight).
GroundReaction full_model_reaction(const RobotModel& model, const CommandSample& sample,
                                   RobotData& data);

}  // namespace ayumi
