#pragma once
// SHA-256 of bytes that arrive one after the other, such as the lines of a long table.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace ayumi {

class Sha256Stream {
 public:
  Sha256Stream();
  ~Sha256Stream();
  void add(std::string_view bytes);
  /// The hash of all bytes so far, in the form of sha256(). Nothing may be added afterwards.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of a file, in the form of sha256(). The file is read piece by piece. Throws the errors
/// of RegularFile.
std::string sha256_of_file(const std::filesystem::path& path, size_t max_bytes);

}  // namespace ayumi
