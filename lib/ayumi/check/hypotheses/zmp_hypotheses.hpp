#pragma once
// Mistakes in keys that put the ZMP under a foot that does not carry the robot, and missing keys of
// the ZMP. Each function adds to `made` the changes of the pattern that it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// All keys of the ZMP under the foot that carries the robot alone.
void all_zmp_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// All keys of the ZMP with left and right exchanged.
void zmp_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The keys of the ZMP in one phase under the foot that carries the robot, and missing keys there.
void zmp_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
