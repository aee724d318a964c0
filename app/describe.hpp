#pragma once
// The command line as a manual page and as completion for shells. Both are read from the options
// that CLI11 parses by, so they are the same in all of them.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace ayumi::app {

/// "man", "bash", "zsh", "fish"
const std::vector<std::string>& description_kinds();

/// The text of one kind. `version` is that of the program. Throws Error(usage) for an unknown kind.
std::string described(const CLI::App& app, const std::string& kind, const std::string& version);

}  // namespace ayumi::app
