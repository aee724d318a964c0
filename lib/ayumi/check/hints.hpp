#pragma once
// Findings in words: where, and what to do about it, with numbers.

#include "ayumi/check/finding_windows.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

/// Joint, foot, axis or pair of bodies of a violation.
std::string where_text(const RobotModel& model, const std::vector<CollisionModel::Pair>& pairs,
                       const Violation& violation);

/// What to do, one sentence. `friction` is the coefficient the check used.
std::string hint_text(const RobotModel& model, const FindingWindow& window, double dt,
                      double friction);

}  // namespace ayumi
