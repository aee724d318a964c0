#pragma once
// Rates of a sampled motion, and the ground reaction of the full model for it.

#include <span>
#include <vector>

#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Fills velocities and accelerations of base, joints and COG by central differences of fourth
/// order. With `rest_ends`, the motion is at rest before its first sample and after its last;
/// otherwise it continues as a cubic.
void fill_rates(std::vector<CommandSample>& samples, double dt, bool rest_ends);

/// Fills the rates of the samples from `first` to before `end`. Different threads may fill
/// different samples at once.
void fill_rates(std::vector<CommandSample>& samples, int first, int end, double dt, bool rest_ends);

/// The ZMP at the height of `sample.zmp` and the ground force that the full model needs. If the
/// force is below 5 % of the weight, as in flight, the ZMP is the point under the base.
GroundReaction full_model_reaction(const RobotModel& model, const CommandSample& sample,
                                   RobotData& data);

/// The results of full_model_reaction() for many samples, equal up to rounding and computed much
/// faster. `dynamics` belongs to `model`.
void full_model_reactions(const RobotModel& model, std::span<const CommandSample> samples,
                          TreeDynamics& dynamics, std::vector<GroundReaction>& reactions);

}  // namespace ayumi
