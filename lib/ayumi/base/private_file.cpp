#include "ayumi/base/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <string>

namespace ayumi {

namespace fs = std::filesystem;

bool write_private_file(const fs::path& path, std::string_view bytes) {
  // The file gets its name when it is complete.
  static std::atomic<unsigned> count = 0;
  const std::string written =
      path.string() + "." + std::to_string(getpid()) + "." + std::to_string(count++);
  const int file = open(written.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                        S_IRUSR | S_IWUSR);
  if (file < 0) return false;
  size_t done = 0;
  for (ssize_t part = 1; part > 0 && done < bytes.size();)
    if (part = write(file, bytes.data() + done, bytes.size() - done); part > 0)
      done += static_cast<size_t>(part);
  std::error_code failed, ignored;
  if (close(file) != 0 || done < bytes.size())
    failed = std::make_error_code(std::errc::io_error);
  else
    fs::rename(written, path, failed);
  if (failed) fs::remove(written, ignored);
  return !failed;
}

}  // namespace ayumi
