#include "ayumi/base/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/regular_file.hpp"
#include "ayumi/base/unfinished_files.hpp"

namespace ayumi {

namespace fs = std::filesystem;

RegularFile::RegularFile(const fs::path& path, size_t max_bytes)
    : path_(path), max_bytes_(max_bytes) {
  // The kind is read from the open file, because another process could replace the file at the
  // path. Without O_NONBLOCK, opening a named pipe would wait for its writer.
  const int opened = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (opened < 0 && errno == ENOENT) refuse("no such file");
  if (opened < 0 && errno == ENXIO)
    refuse("this is a socket or a device, but a regular file is needed");
  if (opened < 0) refuse(std::string("the file cannot be read (") + std::strerror(errno) + ")");
  try {
    struct stat about {};
    if (::fstat(opened, &about) != 0)
      refuse(std::string("the file cannot be read (") + std::strerror(errno) + ")");
    if (S_ISDIR(about.st_mode)) refuse("this is a folder, but a file is needed");
    if (!S_ISREG(about.st_mode))
      refuse("this is a device or a named pipe, but a regular file is needed");
    size_ = static_cast<size_t>(about.st_size);
    require_size(size_);
  } catch (...) {
    ::close(opened);
    throw;
  }
  descriptor_ = opened;
}

RegularFile::~RegularFile() { ::close(descriptor_); }

void RegularFile::refuse(const std::string& reason) const {
  fail(ErrorCode::bad_file, {path_.string()}, reason);
}

void RegularFile::require_size(size_t size) const {
  if (size > max_bytes_)
    refuse("the file has " + std::to_string(size) +
           " bytes; a file of this kind may have at most " + std::to_string(max_bytes_));
}

size_t RegularFile::read(char* to, size_t room) {
  ssize_t more = -1;
  do more = ::read(descriptor_, to, room);
  while (more < 0 && errno == EINTR);
  if (more < 0) refuse(std::string("reading failed (") + std::strerror(errno) + ")");
  got_ += static_cast<size_t>(more);
  require_size(got_);
  return static_cast<size_t>(more);
}

std::string RegularFile::next(size_t count) {
  std::string bytes(count, '\0');
  size_t got = 0;
  while (const size_t more = got < count ? read(bytes.data() + got, count - got) : 0) got += more;
  bytes.resize(got);
  return bytes;
}

std::string read_file(const fs::path& path, size_t max_bytes) {
  RegularFile file(path, max_bytes);
  // Some files, such as those of /proc, state no size, and a file may grow while it is read.
  std::string bytes(file.stated_size() + 1, '\0');
  size_t got = 0;
  while (const size_t more = file.read(bytes.data() + got, bytes.size() - got)) {
    got += more;
    if (got == bytes.size()) bytes.resize(2 * bytes.size());
  }
  bytes.resize(got);
  return bytes;
}

namespace {

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

void require_file_target(const fs::path& path) {
  const fs::path folder = folder_of(path);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(ErrorCode::bad_file, {path.string()},
         "the folder " + folder.string() + " does not exist; create it first");
  const auto refuse = [&](const std::string& reason) {
    fail(ErrorCode::bad_file, {path.string()}, reason);
  };
  switch (fs::symlink_status(path, error).type()) {
    case fs::file_type::not_found:
    case fs::file_type::regular:
      return;
    case fs::file_type::directory:
      refuse("this is a folder; name a file");
      break;
    case fs::file_type::symlink:
      refuse(
          "this is a symbolic link, which Ayumi neither replaces nor follows; name the file to "
          "which the link points");
      break;
    case fs::file_type::character:
    case fs::file_type::block:
      refuse("this is a device, but a regular file is needed");
      break;
    case fs::file_type::fifo:
      refuse("this is a named pipe, but a regular file is needed");
      break;
    case fs::file_type::socket:
      refuse("this is a socket, but a regular file is needed");
      break;
    default:
      refuse("the file cannot be written (" + (error ? error.message() : "unknown type of file") +
             ")");
  }
}

void refuse_existing(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(path, ignored)))
    fail(ErrorCode::bad_file, {path.string()},
         "this already exists; choose another name, or overwrite it with --force");
}

void write_file_with(const fs::path& path, const std::function<void(const fs::path&)>& produce) {
  require_file_target(path);
  const fs::path folder = folder_of(path);
  const fs::path temporary = folder / (path.stem().string() + ".part" + std::to_string(getpid()) +
                                       path.extension().string());
  const UnfinishedPath unfinished(temporary);
  try {
    produce(temporary);
    fs::rename(temporary, path);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(ErrorCode::bad_file, {path.string()},
         "the file cannot be written (" + error.code().message() + ")");
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

void write_file(const fs::path& path, const std::string& bytes) {
  write_file_with(path, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream)
      fail(ErrorCode::bad_file, {path.string()},
           std::string("the file cannot be written (") + std::strerror(errno) + ")");
  });
}

}  // namespace ayumi
