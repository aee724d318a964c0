#pragma once
// Locks of folders and files, which programs hold while they write. The operating system ends a
// lock with the process, however the process ends.

#include <filesystem>
#include <optional>
#include <string>

#include "ayumi/base/unfinished_files.hpp"

namespace ayumi {

/// A folder that is locked by the file `.ayumi_lock` in it. It is made if necessary.
struct LockedFolder {
  std::filesystem::path folder, file;
  int made = 0;  ///< how many folders the lock has made: this one, the one around it, and so on
  int descriptor = -1;
  /// Removes the file and those folders if the process must end while it holds the lock.
  std::optional<UnfinishedPath> unfinished = {};
};

/// Throws Error(bad_file) "`name`: why" if the folder cannot be made or another process holds it;
/// `busy` says that another process holds it.
LockedFolder lock_folder(const std::filesystem::path& folder, const std::string& name,
                         const std::string& busy);
/// Removes the file of the lock; also removes the folders that the lock has made and that are
/// empty.
void unlock_folder(LockedFolder& locked);

/// Makes a folder if necessary and locks it against every other FolderLock on it, in this and in
/// other processes. The operating system ends the lock with the process, however the process ends;
/// only the hidden file `.ayumi_lock` may then stay behind, which the next lock takes over. The
/// destructor removes that file; it also removes the folder, and the folders around it, if this
/// lock has made them and they are empty.
class FolderLock {
 public:
  /// Throws Error(bad_file) with the folder if it cannot be made, or if another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  LockedFolder locked_;
};

/// Locks a file that several programs could write, against every other FileLock on it. The lock is
/// a folder with the name of the file plus `.lock`, because the file itself is replaced.
class FileLock {
 public:
  /// Throws Error(bad_file) with the file if another process writes it, or if it cannot be locked.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  LockedFolder locked_;
};

}  // namespace ayumi
