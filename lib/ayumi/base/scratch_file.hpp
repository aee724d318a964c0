#pragma once
// Bytes that long work keeps on the disk rather than in memory, to read them again at its end.

#include <filesystem>
#include <string>
#include <string_view>

namespace ayumi {

/// An open file without a name: it ends with this object, and with the process, however that ends.
/// Where the file system cannot take away the name of an open file, it ends with this object only.
class ScratchFile {
 public:
  /// Makes the file on the disk of `folder`. Throws Error(bad_file) naming the folder.
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws Error(bad_file) when the disk is full.
  void append(std::string_view bytes);
  size_t size() const { return size_; }
  /// Reads `count` of its bytes from byte `begin` on. Throws Error(bad_file) when they cannot be
  /// read.
  std::string read(size_t begin, size_t count) const;

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  std::filesystem::path folder_;
  std::string name_;  // where the file system keeps the name of an open file; else empty
  int descriptor_ = -1;
  size_t size_ = 0;
};

}  // namespace ayumi
