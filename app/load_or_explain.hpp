#pragma once
// Loads a pattern for the commands that help to correct it.

#include <string>
#include <vector>

#include "pattern_input.hpp"

namespace ayumi::app {

/// Does the same as load_pattern(). If the pattern cannot be sampled, the error also names the
/// values that are its likely causes, judged with `tolerances` ("kind=value").
Task load_or_explain(const Context& context, const std::string& file, const PatternOptions& options,
                     const std::vector<std::string>& tolerances);

}  // namespace ayumi::app
