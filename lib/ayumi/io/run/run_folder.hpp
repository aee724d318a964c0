#pragma once
// A RUN is the folder that run and simulate write. run.json contains verdicts, options, provenance
// and fingerprints, log_<name>.bin are the simulation logs, and reference.csv is the table to
// replay. The content does not depend on the time, the place or the number of threads with which it
// was made.

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
  /// Logs by name: "open_loop", "closed_loop", "undisturbed".
  std::map<std::string, SimulationLog> logs;
  /// Logs whose files are already in the folder. Their samples may be in `logs` or not.
  std::map<std::string, WrittenLog> written = {};
  std::optional<ReferenceTrajectory> reference;  ///< table reference.csv, of an undisturbed run
  std::optional<ReferenceTrajectory> pushed;     ///< table reference_pushed.csv, of a disturbed run
  /// Cautions for the heads of these tables.
  TableCaution reference_caution = {}, pushed_caution = {};
  /// Whether the run has no tables, which follow from the logs. In this case, run.json contains
  /// what the heads of the tables would say.
  bool light = false;
  std::vector<std::string> files;  ///< other existing files in the folder, by relative path
  /// Reasons why the run gives no table for a robot: an inconsistent pattern, a run that fell or
  /// did not settle. Empty if there is no such reason.
  std::vector<std::string> unfit = {};
};

/// Writes the folder, and makes it if necessary. run.json is written last, with the SHA-256 of
/// every file and of its own text. Throws Error(bad_file) if something cannot be written or a named
/// file does not exist.
void write_run(const std::filesystem::path& folder, const RunFolder& run);

/// Names of the files that belong to the run in `folder`, run.json included. Throws Error(bad_file)
/// if its run.json cannot be read as that of a run.
std::vector<std::string> run_file_names(const std::filesystem::path& folder);

/// Whether the run in `folder` lists a file with the name of `file` and the same bytes. Throws the
/// same errors as run_file_names(), and if `file` cannot be read.
bool is_file_of_run(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Throws Error(bad_file) that names the file if the run is not as it was written. run.json is
/// compared with the SHA-256 of its own text, and every listed file with its own SHA-256. Returns
/// the bytes of the listed file `keep` that were compared; nothing if there is no such file.
std::optional<std::string> verify_run(const std::filesystem::path& folder,
                                      const std::string& keep = "");

/// The files of a run that are compared with run.json: those that are read, or all as by
/// verify_run().
enum class ComparedFiles { read, all };

/// Reads the run. Throws Error(bad_file) that names the file if it is not a run, has another
/// format, or if a file is missing, truncated or changed (by its fingerprint). What is read is what
/// was compared, even if another process changes the files at the same time.
RunFolder read_run(const std::filesystem::path& folder,
                   ComparedFiles compared = ComparedFiles::read);

/// The JSON text of one member of run.json ("check"); empty if there is none, and for a log file.
/// Throws the same errors as read_run().
std::string read_run_section(const std::filesystem::path& path, const std::string& key);

/// One log of a run: the one with this name, or else closed_loop, or else the first one. `path` may
/// also be a log file itself.
SimulationLog read_run_log(const std::filesystem::path& path, const std::string& name = "");
/// The same log of a run that was read from `folder`.
const SimulationLog& log_of_run(const RunFolder& run, const std::filesystem::path& folder,
                                const std::string& name = "");

/// Whether `path` is a folder with a run.json.
bool is_run_folder(const std::filesystem::path& path);

/// The name of a log's file, such as "log_closed_loop.bin".
std::string log_file_name(const std::string& name);

}  // namespace ayumi
