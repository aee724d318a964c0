#include "ayumi/base/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
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
  LockedFolder locked{.folder = folder, .file = folder / ".ayumi_lock"};
  for (int i = 0; i < kTries; ++i) {
    std::error_code error;
    locked.made = fs::create_directories(folder, error) || locked.made;
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
      return locked;
    }
    ::close(descriptor);
  }
  stop(
      "cannot be locked, because other processes lock it again and again; wait until they have "
      "ended, or choose another name");
  return locked;
}

void unlock_folder(const LockedFolder& locked) {
  ::unlink(locked.file.c_str());
  ::close(locked.descriptor);
  if (locked.made) ::rmdir(locked.folder.c_str());  // this only succeeds for an empty folder
}

FileLock::FileLock(const fs::path& file)
    : locked_(lock_folder(file.string() + ".lock", file.string(),
                          "another command is writing to this file; wait until it has ended, or "
                          "choose another name")) {}

FileLock::~FileLock() { unlock_folder(locked_); }

}  // namespace ayumi
