#pragma once
// Files and words of repairs: locks as the user writes them, and a repaired pattern with the files
// that it names.

#include <string>
#include <vector>

#include "ayumi/repair/task/repair_task.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// Reads locks in words: a joint ("l_elbow"), a foot ("foot:left"), a keyframe ("keyframe:3",
/// counted from 0 as in messages) or a time window ("1.2..1.8"). Throws Error(usage) for anything
/// else. A window must begin before `duration` [s].
void read_locks(const std::vector<std::string>& words, const Pattern& pattern, double duration,
                RepairOptions& options);

/// Writes `text`, a pattern that was read from `from`, as `to`, byte for byte. If `to` is in
/// another folder, the table and the posture libraries that the pattern names are written beside
/// `to`. Returns false and writes nothing if they cannot be copied: their paths leave the folder,
/// or the robot is named by a relative path.
bool write_with_companions(const Context& context, const std::string& from, const std::string& to,
                           const std::string& text);

}  // namespace ayumi::app
