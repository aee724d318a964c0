#pragma once
// A walk whose steps change, for example a walk that becomes faster.

#include <vector>

#include "ayumi/author/generate/generate.hpp"

namespace ayumi {

/// The steps of each part, one part after the other without a pause, and then the step that brings
/// the feet together. The first foot and the COG height are those of the first part. Throws the
/// same errors as walk_pattern, and Error(usage) for parts of different COG height and for stairs
/// in several parts. `decimals` is the number of decimals of the footholds [m, rad]. With few
/// decimals, a person can read the pattern; with many decimals, all steps of a part are alike.
Pattern walk_in_parts(const RobotModel& model, const std::vector<WalkParameters>& parts,
                      int decimals = 4);

}  // namespace ayumi
