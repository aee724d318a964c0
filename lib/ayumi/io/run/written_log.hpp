#pragma once
// What is known of a log whose samples are in a file, or were not kept.

#include <string>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct WrittenLog {
  SimulationLog about = {};    ///< without samples
  size_t rows = 0;             ///< of its samples
  std::string log_hash = {};   ///< of the whole log, as log_hash() states it
  std::string file_hash = {};  ///< SHA-256 of the file; empty: there is none
};

}  // namespace ayumi
