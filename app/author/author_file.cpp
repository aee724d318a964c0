#include "author/author_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

// RENAME_EXCHANGE of linux/fs.h; glibc's stdio.h only names it for GNU sources.
constexpr unsigned kExchange = 2;

// Exchanges the files of both names at one instant. Returns false if the file system cannot do
// this.
bool exchange(const fs::path& a, const fs::path& b) {
  return ::syscall(SYS_renameat2, AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), kExchange) == 0;
}

class TemporaryFile {
 public:
  TemporaryFile(const fs::path& beside, const std::string& bytes)
      : path_(beside.parent_path() / (beside.stem().string() + ".part" + std::to_string(getpid()) +
                                      beside.extension().string())) {
    std::ofstream stream(path_, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream)
      fail(ErrorCode::bad_file, {beside.string()},
           std::string("the file cannot be written (") + std::strerror(errno) + ")");
  }
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

bool replace_text(const fs::path& file, const std::string& expected, const std::string& text) {
  require_file_target(file);
  if (read_file(file) != expected) return false;
  const TemporaryFile written(file, text);
  struct stat about {};
  if (::stat(file.c_str(), &about) == 0)
    static_cast<void>(::chmod(written.path().c_str(), about.st_mode & 07777));
  // Another program may save between the comparison and the exchange. So the text that the exchange
  // has removed is compared again, and it is put back if it is not the expected one.
  if (exchange(written.path(), file)) {
    if (read_file(written.path()) == expected) return true;
    exchange(written.path(), file);
    return false;
  }
  std::error_code error;
  fs::rename(written.path(), file, error);
  if (error)
    fail(ErrorCode::bad_file, {file.string()},
         "the file cannot be written (" + error.message() + ")");
  return true;
}

void TextHistory::add(const std::string& text) {
  if (at_ >= 0 && present() == text) return;
  texts_.resize(static_cast<size_t>(at_ + 1));
  texts_.push_back(text);
  ++at_;
}

}  // namespace ayumi::app
