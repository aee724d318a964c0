#pragma once
// Files and folders that are removed if the process must end before its work has stopped, for
// example because a computing library does not stop after Ctrl-C. Otherwise they would stay behind.

#include <filesystem>

namespace ayumi {

/// While this object exists, remove_unfinished() removes the path. A path that is too long for the
/// system, or that comes after 64 others, is not removed.
class UnfinishedPath {
 public:
  /// A folder is removed with everything in it. Symbolic links in it are removed and not followed.
  enum class Kind { file, folder };

  /// `made` is the number of folders to remove afterwards if they are empty: first the folder
  /// around the path, then the folder around that one, and so on.
  explicit UnfinishedPath(const std::filesystem::path& path, Kind kind = Kind::file, int made = 0);
  ~UnfinishedPath() { release(); }
  UnfinishedPath(UnfinishedPath&& other) noexcept : slot_(other.slot_) { other.slot_ = -1; }
  UnfinishedPath(const UnfinishedPath&) = delete;
  UnfinishedPath& operator=(const UnfinishedPath&) = delete;
  /// The path is not removed any more. If it is being removed, this function does not return,
  /// because the process is about to end.
  void release();

 private:
  int slot_ = -1;
};

/// Removes these paths, the latest first. A signal handler may call it. The process must end
/// afterwards, because other threads may still use the files.
void remove_unfinished();

}  // namespace ayumi
