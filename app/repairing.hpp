#pragma once
// What repair and run share: steering from words, and the repair of a pattern that may already
// carry a correction.

#include <string>
#include <vector>

#include "ayumi/repair/repair.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// What the pattern itself wishes of its repair.
RepairOptions wished_options(const Pattern& pattern);

/// Locks in words: a joint ("l_elbow"), a foot ("foot:left"), a keyframe ("keyframe:3", counted
/// from 0 as in messages) or a time window ("1.2..1.8"). Throws Error(usage) for anything else.
/// A window must begin before `duration` [s].
void read_locks(const std::vector<std::string>& words, const Pattern& pattern, double duration,
                RepairOptions& options);

/// repair() of what the pattern samples to; where an older correction is there and does not do, of
/// what the author wrote without it.
RepairResult repair_input(const Context& context, const Task& input, const RepairOptions& options);

/// Writes `text`, a pattern read from `from`, as `to`: byte for byte, with the table and the
/// posture libraries it names beside it when that is another folder. False, and nothing written,
/// where they cannot go along: paths that leave the folder, or a robot by a relative path.
bool write_with_companions(const Context& context, const std::string& from, const std::string& to,
                           const std::string& text);

}  // namespace ayumi::app
