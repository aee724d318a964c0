#pragma once
// The names that may stand at a place of the command line. The completion of shells uses them.

#include <string>
#include <vector>

#include "commands.hpp"

namespace ayumi::app {

/// Prints the names of the kinds, one in each line. `kinds` are separated by commas: "robots",
/// "joints", "postures", "profiles", "gains", "controllers", "plants" or "equations". For "robots"
/// together with other kinds, prints only robots until a robot is named, and afterwards only the
/// other kinds. `words` are those of the command line that is being typed. The robot is that of
/// `--robot`, or else of the first robot, pattern or run among `words`, or else the one that `new`
/// uses. A shell that completes a word needs no message, so nothing is printed if a file cannot be
/// read.
void print_names(const Context& context, const std::string& kinds,
                 const std::vector<std::string>& words);

}  // namespace ayumi::app
