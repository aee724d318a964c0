#pragma once
// A RUN: the folder that run and simulate write. run.json holds verdicts, options, provenance and
// fingerprints; log_<name>.bin the simulation logs; reference.csv the table to replay. Nothing in
// it depends on when, where or with how many threads it was made.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct RunFolder {
  Provenance provenance;
  /// Further members of run.json: key and JSON text, in order ("check", check_json(report)).
  std::vector<std::pair<std::string, std::string>> sections;
  std::map<std::string, SimulationLog> logs;     ///< "open_loop", "closed_loop"
  std::optional<ReferenceTrajectory> reference;  ///< reference.csv
  std::vector<std::string> files;                ///< others in the folder, relative, existing
};

/// Writes the folder, making it where needed; run.json comes last, with the SHA-256 of every file.
/// Throws Error(bad_file) when something cannot be written or a named file does not exist.
void write_run(const std::filesystem::path& folder, const RunFolder& run);

/// Reads it back. Throws Error(bad_file) naming the file: not a run, another format, a log missing,
/// truncated or changed since (by its fingerprint).
RunFolder read_run(const std::filesystem::path& folder);

/// One log of a run: by name, or closed_loop when there is one, else the only one. `path` may also
/// be a log file itself.
SimulationLog read_run_log(const std::filesystem::path& path, const std::string& name = "");

/// Whether `path` is a folder with a run.json.
bool is_run_folder(const std::filesystem::path& path);

/// "log_closed_loop.bin"
std::string log_file_name(const std::string& name);

}  // namespace ayumi
