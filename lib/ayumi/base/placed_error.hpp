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
  /// The error is about a name that nothing has, so that no other number mends it.
  bool unknown_name = false;
  /// The error names the value that is wrong. The cause of an error that leaves other errors does
  /// not.
  bool names_value = false;

  bool empty() const { return file.empty() && pointer.empty() && line == 0; }
};

class PlacedError : public Error {
 public:
  PlacedError(ErrorCode code, const std::string& message, SourcePlace place)
      : Error(code, message), place_(std::move(place)) {}
  const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// Throws an error of a pattern that names what is not there, without a place.
[[noreturn]] inline void fail_unknown_name(const std::string& message) {
  SourcePlace nowhere;
  nowhere.unknown_name = true;
  throw PlacedError(ErrorCode::bad_pattern, message, nowhere);
}

inline bool names_its_value(const Error& error) {
  const auto* const placed = dynamic_cast<const PlacedError*>(&error);
  return placed && placed->place().names_value;
}

inline bool is_of_unknown_name(const Error& error) {
  const auto* const placed = dynamic_cast<const PlacedError*>(&error);
  return placed && placed->place().unknown_name;
}

/// Calls `work`. An Error that leaves it without a place gets this one; its message stays.
template <typename Work>
auto at_place(SourcePlace place, const Work& work) {
  try {
    return work();
  } catch (const PlacedError& error) {
    if (!error.place().empty()) throw;
    place.unknown_name = error.place().unknown_name;
    throw PlacedError(error.code(), error.what(), place);
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
