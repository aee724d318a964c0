#pragma once
// Bytes that long work keeps on the disk instead of in memory, to read them again at its end.

#include <filesystem>
#include <string>
#include <string_view>

namespace ayumi {

/// An open file without a name: it is deleted with this object, and with the process, however the
/// process ends. If the file system cannot remove the name of an open file, only the destructor of
/// this object deletes the file.
class ScratchFile {
 public:
  /// Makes the file on the disk of `folder`. Throws Error(bad_file) with the folder.
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Appends bytes at the end. Throws Error(bad_file) if the disk is full.
  void append(std::string_view bytes);
  size_t size() const { return size_; }
  /// Reads `count` of the file's bytes, starting at byte `begin`. Throws Error(bad_file) if they
  /// cannot be read.
  std::string read(size_t begin, size_t count) const;

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  std::filesystem::path folder_;
  std::string name_;  // name of the open file if the file system keeps it; otherwise empty
  int descriptor_ = -1;
  size_t size_ = 0;
};

}  // namespace ayumi
