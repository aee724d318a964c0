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
/// table finding follows from an error of the motion itself that reaches it: within the influence
/// interval of the error, or, for an error of a rate or a force, between the same two rests of the
/// motion.
void add_table_findings(JudgedMotion& motion, std::vector<FindingWindow>& windows);

/// The rows of the table in their order. Each names a cause, what follows from it, in which
/// interval, and under which condition.
std::vector<std::array<std::string, 4>> attribution_table();

}  // namespace ayumi
