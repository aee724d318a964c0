#pragma once
// Reads a file piece by piece.

#include <filesystem>
#include <string>

namespace ayumi {

/// A regular file that is open for reading. Opening never waits, for example for a writer.
class RegularFile {
 public:
  /// Throws Error(bad_file) with the path and the reason if the file is missing, a directory, a
  /// device, a named pipe, a socket, unreadable, or larger than `max_bytes`.
  RegularFile(const std::filesystem::path& path, size_t max_bytes);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  /// The size that the system states. Files of /proc state 0, and a file may grow.
  size_t stated_size() const { return size_; }
  /// Reads the next bytes to `to`, at most `room`. Returns the number of bytes that were read; 0 at
  /// the end of the file. Throws Error(bad_file) if reading fails, or if the file has grown beyond
  /// its largest size.
  size_t read(char* to, size_t room);
  /// The next bytes: `count`, or fewer at the end of the file.
  std::string next(size_t count);

 private:
  [[noreturn]] void refuse(const std::string& reason) const;
  void require_size(size_t size) const;
  std::filesystem::path path_;
  size_t max_bytes_, size_ = 0, got_ = 0;
  int descriptor_ = -1;
};

}  // namespace ayumi
