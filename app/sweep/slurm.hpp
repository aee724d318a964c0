#pragma once
// Runs cases of a sweep as job arrays of Slurm. A pilot run on this machine determines the size of
// the tasks. Each task writes its rows into its own file, and these files are merged as they
// arrive. The state of a task is read from its file and from the queue; no accounting is needed.
// docs/slurm.md describes the engine.

#include "sweep/run_cases.hpp"

namespace ayumi::app {

struct SlurmOptions {
  std::string partition, time, memory;  ///< values for sbatch; "": its defaults
  std::vector<std::string> further;     ///< more options for sbatch, as words
  int attempts = 3;           ///< how often a case is submitted before the engine gives up
  int pilot = 8;              ///< number of cases of the pilot run
  long chunk = 0;             ///< number of cases of a task; 0: from the pilot run
  double task_seconds = 300;  ///< time that a task should take [s]
};

/// The folder in which the state of the engine is kept: "results.db.slurm".
std::filesystem::path slurm_folder(const std::filesystem::path& results);

/// Numbers of cases in rising order, as ranges [first, last].
using CaseRanges = std::vector<std::pair<long, long>>;
/// Reads a text such as "0-99,120" as ranges, and writes ranges as such a text. Throws Error(usage)
/// for numbers that are not from 0 to `count` - 1 in rising order.
CaseRanges read_case_ranges(const std::string& text, long count);
std::string text_of(const CaseRanges& ranges);

/// Number of cases of a task. `seconds` is the time of one case; `setup` is the time of a task
/// before its first case.
long chunk_size(double seconds, double setup, long cases, double task_seconds);

/// A limit of time as sbatch reads it ("30", "2:00:00", "1-12") [s]; 0 if there is none.
double slurm_seconds(const std::string& time);

/// Throws Error(bad_file) with one line if Slurm's programs cannot be started here.
void require_slurm();

/// Submits, waits and merges until every case has a row. Also waits for tasks of an earlier call
/// that are still queued. Throws Error(bad_file) with one line if Slurm is missing, refuses, does
/// not answer any more, or has lost a case too often. Rows that have arrived are always kept. If
/// `progress` stops the work, Interrupted is thrown and the tasks continue.
RunCost run_on_slurm(const Context& context, const CaseRunner& runner, ResultsDatabase& results,
                     const std::vector<bool>& missing, const SlurmOptions& options,
                     const Progress& progress);

/// State of the tasks that were submitted for these results.
struct SlurmStatus {
  bool exists = false;  ///< true: tasks were submitted and not all were collected
  long waiting = 0, running = 0, arrived = 0;
  std::string name;     ///< name of the jobs
  std::string reason;   ///< reason why tasks wait, in Slurm's word
  std::string trouble;  ///< reason why the queue is not known; "" if it is known
};
SlurmStatus slurm_status(const std::filesystem::path& results);

}  // namespace ayumi::app
