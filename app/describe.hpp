#pragma once
// The command line as a manual page and as completion for shells. Both are made from the options by
// which CLI11 parses the command line, so they cannot differ from it.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace ayumi::app {

/// The kinds: "man", "bash", "zsh", "fish".
const std::vector<std::string>& description_kinds();

/// The text of one kind. `version` is that of the program. Throws Error(usage) for an unknown kind.
std::string described(const CLI::App& app, const std::string& kind, const std::string& version);

}  // namespace ayumi::app
