#include "ayumi/base/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

// Chosen: of one process, two files are in this moment at a time at most.
constexpr int kMostNames = 100;

}  // namespace

ScratchFile::ScratchFile(std::filesystem::path folder) : folder_(std::move(folder)) {
  // A name is needed for a moment only, because not every file system has files without one.
  // A process that was killed in this moment may have left one.
  const std::string begin = ".ayumi_scratch_" + std::to_string(::getpid()) + "_";
  for (int i = 0; i < kMostNames && descriptor_ < 0; ++i) {
    const std::filesystem::path name = folder_ / (begin + std::to_string(i));
    descriptor_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor_ >= 0)
      ::unlink(name.c_str());
    else if (errno != EEXIST)
      break;
  }
  if (descriptor_ < 0) refuse("no file can be made in this folder");
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(descriptor_, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) refuse("the samples cannot be written to a file in this folder");
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
    if (more == 0) errno = EIO;  // shorter than what was written
    if (more <= 0) refuse("the samples cannot be read back from a file in this folder");
    got += static_cast<size_t>(more);
  }
  return bytes;
}

void ScratchFile::refuse(const std::string& what) const {
  fail(ErrorCode::bad_file, folder_.string() + ": " + what + " (" + std::strerror(errno) + ")");
}

}  // namespace ayumi
