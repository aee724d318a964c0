#pragma once
// The information about a log whose samples are in a file or were not kept.

#include <string>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct WrittenLog {
  SimulationLog about = {};    ///< the log without its samples
  size_t rows = 0;             ///< number of its samples
  std::string log_hash = {};   ///< hash of the whole log, as log_hash() computes it
  std::string file_hash = {};  ///< SHA-256 of the file; empty: there is no file
};

}  // namespace ayumi
