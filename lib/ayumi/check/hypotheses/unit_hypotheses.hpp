#pragma once
// Mistakes in units (degrees and radians, s and ms, m, cm and mm), and in times that were all
// stretched by one factor. Each function that has a list `made` adds to it the changes of the
// pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// All angles, read in the other unit.
void angle_units(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Multiplies the times of all phases and keyframes by a factor, as if they had another unit.
void scale_times(Pattern& pattern, double factor);
/// All times, read in ms.
void time_units(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// All times of keyframes, multiplied by one factor with which they fit the phases.
void stretched_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// All lengths, read in mm or cm.
void length_units(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// All targets of the hands and other links, or of the gaze, read in mm or cm.
void target_units(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// One foothold, one key of a foot, one point of the ZMP or one target, read in mm or cm.
void footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
