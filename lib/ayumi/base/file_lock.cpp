#include "ayumi/base/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace fs = std::filesystem;

namespace {

// Whether the open file is still the one of that name. Its last holder may have removed it after we
// opened it and before we locked it.
bool is_file_of(int descriptor, const fs::path& path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// Number of folders that do not exist: this one, the one around it, and so on.
int missing_folders(const fs::path& folder) {
  std::error_code error;
  int missing = 0;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error) && !error; at = at.parent_path())
    ++missing;
  return missing;
}

}  // namespace

LockedFolder lock_folder(const fs::path& folder, const std::string& name, const std::string& busy) {
  // Number of tries. Chosen: another process may remove the folder or the file between two calls,
  // but not a hundred times.
  constexpr int kTries = 100;
  const std::string own =
      name == folder.string() ? "the folder " : "the lock folder " + folder.string() + " ";
  const auto stop = [&](const std::string& reason) {
    fail(ErrorCode::bad_file, {name}, (reason == busy ? "" : own) + reason);
  };
  LockedFolder locked{.folder = (folder / "").parent_path(), .file = folder / ".ayumi_lock"};
  for (int i = 0; i < kTries; ++i) {
    std::error_code error;
    locked.made = std::max(locked.made, missing_folders(locked.folder));
    fs::create_directories(folder, error);
    if (error) stop("cannot be made (" + error.message() + ")");
    const int descriptor =
        ::open(locked.file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (descriptor < 0 && errno == ENOENT) continue;
    if (descriptor < 0) stop(std::string("cannot be written (") + std::strerror(errno) + ")");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      ::close(descriptor);
      if (reason == EWOULDBLOCK) stop(busy);
      stop(std::string("cannot be locked (") + std::strerror(reason) + ")");
    }
    if (is_file_of(descriptor, locked.file)) {
      locked.descriptor = descriptor;
      locked.unfinished.emplace(locked.file, UnfinishedPath::Kind::file, locked.made);
      return locked;
    }
    ::close(descriptor);
  }
  stop(
      "cannot be locked, because other processes lock it again and again; wait until they have "
      "ended, or choose another name");
  return locked;
}

void unlock_folder(LockedFolder& locked) {
  locked.unfinished.reset();  // before another process can take the lock
  ::unlink(locked.file.c_str());
  ::close(locked.descriptor);
  // Destructors call this when no memory is left, so it allocates nothing.
  char folder[PATH_MAX] = {};
  std::strncpy(folder, locked.folder.c_str(), sizeof folder - 1);
  for (int i = 0; i < locked.made && ::rmdir(folder) == 0; ++i) {  // only an empty folder
    char* const end = std::strrchr(folder, '/');
    if (!end) return;
    *end = '\0';
  }
}

FolderLock::FolderLock(const fs::path& folder)
    : locked_(lock_folder(folder, folder.string(),
                          "another run is being written to this folder; wait until it has ended, "
                          "or choose another folder")) {}

FolderLock::~FolderLock() { unlock_folder(locked_); }

FileLock::FileLock(const fs::path& file)
    : locked_(lock_folder(file.string() + ".lock", file.string(),
                          "another command is writing to this file; wait until it has ended, or "
                          "choose another name")) {}

FileLock::~FileLock() { unlock_folder(locked_); }

}  // namespace ayumi
