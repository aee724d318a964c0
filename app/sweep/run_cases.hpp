#pragma once
// Runs cases of a sweep on the threads of this machine and keeps their rows.

#include "sweep/results_database.hpp"

namespace ayumi::app {

/// Cost of a run.
struct RunCost {
  long cases = 0;
  double seconds = 0;  ///< processor time of all threads, rows written included
  double useful = 0;   ///< of them simulating, checking and repairing
};

/// Runs those `cases` (by number) on `threads` (0: all cores). Rows are committed about twice a
/// second, so that a killed program loses no more than that. When `progress` stops the work, all
/// rows that are known are kept and Interrupted is thrown.
RunCost run_cases(const CaseRunner& runner, ResultsDatabase& results,
                  const std::vector<bool>& cases, int threads, const Progress& progress);

}  // namespace ayumi::app
