#pragma once
// SHA-256 of bytes that arrive one after the other, such as the lines of a long table.

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

}  // namespace ayumi
