#pragma once
// Attribution: one fault in a pattern affects many figures. If one finding is sufficient to cause
// another one, the other one is a consequence: it becomes a warning that names its cause, so that
// only the faults to correct remain errors. The rules are data, the rows of the table in
// docs/attribution.md.

#include <array>
#include <string>
#include <vector>

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

/// Sets `cause` and lowers the severity of every error that follows from another one. If there was
/// an error before, at least one error remains.
void mark_consequences(JudgedMotion& motion, std::vector<FindingWindow>& windows);

/// Adds findings for everything that `export` would refuse in the table (JudgedMotion::table). A
/// table finding is a consequence of an error of the motion itself if it is within the influence
/// interval of this error. If the error is one of a rate or a force, it is enough that both are
/// between the same two rests of the motion.
void add_table_findings(JudgedMotion& motion, std::vector<FindingWindow>& windows);

/// The rows of the table in their order. Each row names a cause, its effects, the interval in which
/// they are searched, and their condition.
std::vector<std::array<std::string, 4>> attribution_table();

}  // namespace ayumi
