#include "ayumi/base/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "ayumi/base/error.hpp"

namespace ayumi {

ScratchFile::ScratchFile(std::filesystem::path folder)
    : folder_(folder.empty() ? std::filesystem::path(".") : std::move(folder)) {
  // Not every file system can make a file without a name, so the file has a name for a moment.
  std::string name = (folder_ / ".ayumi_scratch_XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) refuse("no file can be made in this folder");
  // This fails on some network file systems.
  if (::unlink(name.c_str()) != 0) name_ = std::move(name);
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!name_.empty()) ::unlink(name_.c_str());
}

void ScratchFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(descriptor_, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0)
      refuse(
          "the samples of the run cannot be kept in a file in this folder; free some space on its "
          "disk");
    bytes.remove_prefix(static_cast<size_t>(done));
    size_ += static_cast<size_t>(done);
  }
}

std::string ScratchFile::read(size_t begin, size_t count) const {
  std::string bytes(count, '\0');
  size_t got = 0;
  while (got < count) {
    const ssize_t more =
        ::pread(descriptor_, bytes.data() + got, count - got, static_cast<off_t>(begin + got));
    if (more < 0 && errno == EINTR) continue;
    if (more == 0) errno = EIO;  // the file is shorter than what was written
    if (more <= 0) refuse("the samples cannot be read back from a file in this folder");
    got += static_cast<size_t>(more);
  }
  return bytes;
}

void ScratchFile::refuse(const std::string& what) const {
  fail(ErrorCode::bad_file, {folder_.string()}, what + " (" + std::strerror(errno) + ")");
}

}  // namespace ayumi
