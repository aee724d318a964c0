#pragma once
// Mistakes in keys of a foot in the air that move it too far or too high, or that keep it level
// below a leg that leans. Each function adds to `made` the changes of the pattern that it
// describes.

#include <array>
#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

// Shares of the path of a foot in the air that are tried, for all its keys of one swing together.
// Chosen: with less than half, much of the motion is lost, and another change is probably better;
// below a quarter, little of the motion is left.
inline constexpr std::array kMildShares = {0.85, 0.7, 0.55}, kSmallShares = {0.55, 0.4, 0.25};

/// All keys of a foot in one swing, at these shares of its path, of its height, or of both.
void smaller_swings(const ExaminedPattern& of, std::vector<Hypothesis>& made,
                    const std::array<double, 3>& shares);
/// Keys of a level foot, turned with its leg.
void level_feet(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
