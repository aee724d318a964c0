#pragma once
// An error with the place in a file that it is about, for programs that show the place. The message
// alone says everything to people, the place included.

#include <string>

#include "ayumi/base/error.hpp"

namespace ayumi {

struct SourcePlace {
  std::string file;
  std::string pointer;  ///< JSON pointer; "" for the whole file
  int line = 0;         ///< counted from 1; 0: the pointer names the place
};

class PlacedError : public Error {
 public:
  PlacedError(ErrorCode code, const std::string& message, SourcePlace place)
      : Error(code, message), place_(std::move(place)) {}
  const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// Calls `work`. An Error that leaves it without a place gets this one; its message stays.
template <typename Work>
auto at_place(const SourcePlace& place, const Work& work) {
  try {
    return work();
  } catch (const PlacedError&) {
    throw;
  } catch (const Error& error) {
    throw PlacedError(error.code(), error.what(), place);
  }
}

/// Throws `error` again with another message; its place, if it has one, stays.
[[noreturn]] inline void throw_with_message(const Error& error, const std::string& message) {
  if (const auto* const placed = dynamic_cast<const PlacedError*>(&error))
    throw PlacedError(error.code(), message, placed->place());
  throw Error(error.code(), message);
}

}  // namespace ayumi
