#pragma once
// Mistakes in parts of a pattern that are missing, that contradict others, or that make the motion
// jump. Each function adds to `made` the changes of the pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// A missing swing of a foot that stays behind.
void swings(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// A missing phase on both feet between two phases on one foot.
void double_supports(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The removal of keys of leg joints. With such keys, the legs do not follow the inverse
/// kinematics.
void leg_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The removal of keys of one quantity that follows from others.
void superfluous_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Smooth interpolation instead of steps and corners.
void interpolations(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
