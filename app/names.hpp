#pragma once
// The names that may stand at a place of the command line, for the completion of shells.

#include <string>
#include <vector>

#include "commands.hpp"

namespace ayumi::app {

/// Prints the names of the kinds, which commas separate, a line each: "robots", "joints",
/// "postures", "profiles", "gains", "controllers", "plants" or "equations". Of "robots" and other
/// kinds, only the robots until a robot is named, and then only the others. `words` are those of
/// the command line that is being typed: the robot is that of `--robot`, else the first robot,
/// pattern or run among them, else the one that `new` takes. A shell that completes wants no
/// message: where a file cannot be read, nothing is printed.
void print_names(const Context& context, const std::string& kinds,
                 const std::vector<std::string>& words);

}  // namespace ayumi::app
