#pragma once
// Files and words of repairs: locks as the user writes them, and a repaired pattern with what it
// names.

#include <string>
#include <vector>

#include "ayumi/repair/task/repair_task.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// Locks in words: a joint ("l_elbow"), a foot ("foot:left"), a keyframe ("keyframe:3", counted
/// from 0 as in messages) or a time window ("1.2..1.8"). Throws Error(usage) for anything else.
/// A window must begin before `duration` [s].
void read_locks(const std::vector<std::string>& words, const Pattern& pattern, double duration,
                RepairOptions& options);

/// Writes `text`, a pattern read from `from`, as `to`: byte for byte, with the table and the
/// posture libraries it names beside it when that is another folder. False, and nothing written,
/// where they cannot go along: paths that leave the folder, or a robot by a relative path.
bool write_with_companions(const Context& context, const std::string& from, const std::string& to,
                           const std::string& text);

}  // namespace ayumi::app
