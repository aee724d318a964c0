#pragma once
// Reading and writing of whole files.

#include <filesystem>
#include <functional>
#include <string>

namespace ayumi {

/// The bytes of a regular file. Throws Error(bad_file) naming the path and the reason when it is
/// missing, a directory, a device, a named pipe, a socket, unreadable, or larger than `max_bytes`.
/// It never waits. Every reader of Ayumi opens files by this function.
std::string read_file(const std::filesystem::path& path, size_t max_bytes = size_t{1} << 30);

/// Throws Error(bad_file) naming the path where no regular file can be written: it is a folder, a
/// device, a named pipe, a socket or a symbolic link (which is neither replaced nor followed), or
/// its folder does not exist.
void require_file_target(const std::filesystem::path& path);

/// Throws Error(bad_file) when something exists at `path` (a symbolic link to nowhere included).
void refuse_existing(const std::filesystem::path& path);

/// Writes the whole file or nothing: into a temporary name beside it, then renamed. Throws
/// Error(bad_file) naming the path and the reason, and as require_file_target(); an older file at
/// `path` is then untouched.
void write_file(const std::filesystem::path& path, const std::string& bytes);

/// Calls `produce` with a temporary path (same folder, same extension), then renames it to `path`.
/// For writers that need a path of their own. Removes the temporary file when `produce` throws.
void write_file_with(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path&)>& produce);

/// Makes a folder where needed and locks it against every other FolderLock on it, in this and in
/// other processes. The operating system ends the lock with the process, however it ends; only the
/// hidden file `.ayumi_lock` may then stay behind, which the next lock takes over. The destructor
/// removes that file, and the folder where this lock has made it and it is empty.
class FolderLock {
 public:
  /// Throws Error(bad_file) naming the folder: it cannot be made, or another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_, file_;
  bool made_ = false;
  int descriptor_ = -1;
};

}  // namespace ayumi
