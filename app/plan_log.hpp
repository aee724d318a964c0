#pragma once
// The log of a run, or the plan of a pattern as a log. Previews and plots show both.

#include <string>

#include "ayumi/sim/simulation_log.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// Whether a name is that of a pattern rather than of a RUN: a file that ends in .json or .jsonc.
bool names_pattern(const std::string& file);

/// The log of a RUN, or the plan of a pattern. `log` says which log of the run. Throws as
/// read_run_log() and load_pattern().
SimulationLog log_of(const Context& context, const std::string& run_or_pattern,
                     const std::string& log);

}  // namespace ayumi::app
