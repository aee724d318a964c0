#pragma once
// Finds footholds at which the two feet of the robot overlap. The finding of the check names two
// bodies and a window of time; what the author wrote is a step that turns too far or is too narrow.

#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

/// The swings that bring a foot a little inside the other one, at most three of them. Each comes
/// with the smallest step to the side and the largest turn with which the feet are apart and the
/// check finds fewer errors. If the feet overlap by more, as after an exchange of left and right,
/// likely_mistakes() gives a better explanation. The function samples and checks the pattern up to
/// twice for each swing.
std::vector<Mistake> foothold_collisions(const Task& task, const CheckOptions& options,
                                         const ConsistencyReport& report);

/// The likely mistakes of an inconsistent pattern: first these footholds, then those of
/// likely_mistakes(). If likely_mistakes() names one value of the same phase that explains
/// everything, only that one is returned.
std::vector<Mistake> likely_causes(const Task& task, const CheckOptions& options,
                                   const ConsistencyReport& report, const Progress& progress = {});

}  // namespace ayumi
