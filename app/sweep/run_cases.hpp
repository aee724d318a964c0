#pragma once
// Runs cases of a sweep on the threads of this machine and keeps their rows.

#include "sweep/results_database.hpp"

namespace ayumi::app {

/// The cost of a run.
struct RunCost {
  long cases = 0;
  double seconds = 0;  ///< processor time of all threads, including the writing of rows
  double useful = 0;   ///< the part of it for simulating, checking and repairing
};

/// Runs the given `cases` (by number) on `threads` threads (0: all cores). Rows are committed about
/// twice a second, so that a killed program loses the rows of half a second at most. If `progress`
/// stops the work, all known rows are kept and Interrupted is thrown.
RunCost run_cases(const CaseRunner& runner, ResultsDatabase& results,
                  const std::vector<bool>& cases, int threads, const Progress& progress);

}  // namespace ayumi::app
