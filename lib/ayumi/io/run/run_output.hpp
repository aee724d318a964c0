#pragma once
// Where a run is written to: a folder that only one process fills at a time, in which the files of
// a run appear together when all of them are complete, and in which files of the user stay.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/base/file.hpp"

namespace ayumi {

/// Throws Error(bad_file) when a run may not be written to `folder`: it is no folder; it holds a
/// run and `replace` is false; one of `names` is there and is not a file of that run.
void require_run_target(const std::filesystem::path& folder, bool replace,
                        const std::vector<std::string>& names);

/// A run in the making. Its files are first written to a hidden folder inside the target.
class RunOutput {
 public:
  /// Locks `folder`, making it where needed. Throws Error(bad_file) when another process is writing
  /// a run there, and as require_run_target().
  RunOutput(const std::filesystem::path& folder, bool replace);
  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// Where the files of the run are written before they are delivered.
  const std::filesystem::path& folder() const { return staging_; }
  std::filesystem::path file(const std::string& name) const { return staging_ / name; }

  /// Moves the files of the run that was there out of the way and those of this run to their place,
  /// run.json last. Throws as require_run_target(), or when a file cannot be moved; what was there
  /// is then there again. A process that is killed in between leaves a folder without run.json, in
  /// which the next RunOutput first brings back what was there.
  void deliver() const;

 private:
  std::filesystem::path target_, staging_, replaced_;
  bool replace_;
  FolderLock lock_;
};

}  // namespace ayumi
