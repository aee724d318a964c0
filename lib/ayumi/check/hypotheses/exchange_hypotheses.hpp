#pragma once
// Mistakes in which two things were exchanged: left and right, x and y, or two footholds. Each
// function adds to `made` the changes of the pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// One phase with left and right exchanged, and footholds that were exchanged with later ones.
void phase_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Footholds that were exchanged with later ones.
void foothold_exchanges(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Exchanged footholds, where both feet land on the side of the other foot.
void crossed_footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// All feet on the other side: y with the other sign, or left and right exchanged.
void all_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The x and y of one place, exchanged.
void swapped_axes(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The feet at the start, exchanged.
void starts(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The left and the right part of one keyframe, exchanged.
void key_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// A joint of a posture as the mirror image of its partner, if only this pair of joints is not
/// symmetric.
void unlike_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
