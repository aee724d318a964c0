#pragma once
// A RUN: the folder that run and simulate write. run.json holds verdicts, options, provenance and
// fingerprints; log_<name>.bin the simulation logs; reference.csv the table to replay. Its content
// does not depend on the time, the place or the number of threads with which it was made.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/io/run/written_log.hpp"
#include "ayumi/motion/table_caution.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct RunFolder {
  Provenance provenance;
  /// Further members of run.json: key and JSON text, in order ("check", check_json(report)).
  std::vector<std::pair<std::string, std::string>> sections;
  std::map<std::string, SimulationLog> logs;  ///< "open_loop", "closed_loop", "undisturbed"
  /// Logs whose files are in the folder already, with their samples or without them in `logs`.
  std::map<std::string, WrittenLog> written = {};
  std::optional<ReferenceTrajectory> reference;  ///< reference.csv, of an undisturbed run
  std::optional<ReferenceTrajectory> pushed;     ///< reference_pushed.csv, of a disturbed run
  TableCaution reference_caution = {}, pushed_caution = {};  ///< heads of these tables
  /// Without tables, which follow from the logs; run.json then has what their heads would say.
  bool light = false;
  std::vector<std::string> files;  ///< others in the folder, relative, existing
  /// Why the run gives no table for a robot: an inconsistent pattern, a run that fell or did not
  /// settle. Empty if there is no such reason.
  std::vector<std::string> unfit = {};
};

/// Writes the folder, making it where needed; run.json comes last, with the SHA-256 of every file
/// and of its own text.
/// Throws Error(bad_file) when something cannot be written or a named file does not exist.
void write_run(const std::filesystem::path& folder, const RunFolder& run);

/// Names of the files that the run in `folder` consists of, run.json included. Throws
/// Error(bad_file) when its run.json cannot be read as one.
std::vector<std::string> run_file_names(const std::filesystem::path& folder);

/// Whether the run in `folder` lists a file of the name of `file` and with its bytes. Throws as
/// run_file_names(), and where `file` cannot be read.
bool is_file_of_run(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Throws Error(bad_file) naming the file unless the run is as it was written: run.json by the
/// SHA-256 of its own text, every file that it lists by that file's.
void verify_run(const std::filesystem::path& folder);

/// Reads it back. Throws Error(bad_file) naming the file: not a run, another format, a log missing,
/// truncated or changed since (by its fingerprint).
RunFolder read_run(const std::filesystem::path& folder);

/// The JSON text of one member of run.json ("check"); empty where there is none, and for a log
/// file. Throws as read_run().
std::string read_run_section(const std::filesystem::path& path, const std::string& key);

/// One log of a run: by name, or closed_loop when there is one, else the only one. `path` may also
/// be a log file itself.
SimulationLog read_run_log(const std::filesystem::path& path, const std::string& name = "");

/// Whether `path` is a folder with a run.json.
bool is_run_folder(const std::filesystem::path& path);

/// "log_closed_loop.bin"
std::string log_file_name(const std::string& name);

}  // namespace ayumi
