#pragma once
// Cause and consequence: one fault in a pattern shows in many figures. A finding that follows from
// another is told as a warning that names it, so that errors are what there is to mend.

#include <vector>

#include "ayumi/check/check_pass.hpp"

namespace ayumi {

/// Sets `cause` and lowers the severity of every error that follows from another one, by the rules
/// of docs/theory.md ("Cause and consequence"). At least one error stays where there was one.
void explain(CheckPass& pass, std::vector<FindingWindow>& windows);

}  // namespace ayumi
