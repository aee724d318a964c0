#pragma once
// SHA-256 of bytes that come one after the other, such as the lines of a long table.

#include <memory>
#include <string>
#include <string_view>

namespace ayumi {

class Sha256Stream {
 public:
  Sha256Stream();
  ~Sha256Stream();
  void add(std::string_view bytes);
  /// The hash of all bytes so far, as sha256() writes it. Nothing may be added after it.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ayumi
