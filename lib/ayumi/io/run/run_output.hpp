#pragma once
// The folder to which a run is written. Only one process fills it at a time, the files of a run
// appear together when all of them are complete, and files of the user stay in it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/file_lock.hpp"

namespace ayumi {

/// Throws Error(bad_file) if a run may not be written to `folder`: it is not a folder, or it holds
/// a run and `replace` is false, or one of `names` exists and is not a file of that run.
void require_run_target(const std::filesystem::path& folder, bool replace,
                        const std::vector<std::string>& names);

/// A run that is being made. Its files are first written to a hidden folder inside the target.
class RunOutput {
 public:
  /// Locks `folder`, and makes it if necessary. Throws Error(bad_file) if another process is
  /// writing a run there, and the same errors as require_run_target().
  RunOutput(const std::filesystem::path& folder, bool replace);
  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// The folder in which the files of the run are written before they are delivered.
  const std::filesystem::path& folder() const { return staging_; }
  std::filesystem::path file(const std::string& name) const { return staging_ / name; }

  /// Moves the files of the previous run away and the files of this run to their place, run.json
  /// last. Throws the same errors as require_run_target(), or if a file cannot be moved; then the
  /// previous run is brought back. A process that is killed in between leaves a folder without
  /// run.json, and the next RunOutput first brings back the previous run.
  void deliver();

 private:
  std::filesystem::path target_, staging_, replaced_;
  bool replace_;
  FolderLock lock_;
  std::optional<UnfinishedPath> unfinished_;
};

}  // namespace ayumi
