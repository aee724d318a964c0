#include "ayumi/base/file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path, size_t max_bytes) {
  std::error_code status_error;
  const fs::file_status status = fs::status(path, status_error);
  if (!fs::status_known(status))
    fail(ErrorCode::bad_file, path.string() + ": cannot be read (" + status_error.message() + ")");
  if (!fs::exists(status)) fail(ErrorCode::bad_file, path.string() + ": no such file");
  if (fs::is_directory(status))
    fail(ErrorCode::bad_file, path.string() + ": is a directory, a file is needed");
  if (fs::is_regular_file(status) && fs::file_size(path) > max_bytes)
    fail(ErrorCode::bad_file, path.string() + ": " + std::to_string(fs::file_size(path)) +
                                  " bytes, more than the " + std::to_string(max_bytes) +
                                  " that are read");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    fail(ErrorCode::bad_file, path.string() + ": cannot be read (" + std::strerror(errno) + ")");
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) fail(ErrorCode::bad_file, path.string() + ": reading failed");
  return bytes;
}

void write_file_with(const fs::path& path, const std::function<void(const fs::path&)>& produce) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    fail(ErrorCode::bad_file,
         path.string() + ": the folder " + folder.string() + " does not exist; create it first");
  if (fs::is_directory(path))
    fail(ErrorCode::bad_file, path.string() + ": is a directory, a file name is needed");
  const fs::path temporary = folder / (path.stem().string() + ".part" + std::to_string(getpid()) +
                                       path.extension().string());
  try {
    produce(temporary);
    fs::rename(temporary, path);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(ErrorCode::bad_file,
         path.string() + ": cannot be written (" + error.code().message() + ")");
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
      fail(ErrorCode::bad_file,
           path.string() + ": cannot be written (" + std::strerror(errno) + ")");
  });
}

}  // namespace ayumi
