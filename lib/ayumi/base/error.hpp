#pragma once
// Errors that name a place and a remedy. They are thrown at the edges of the library (files,
// models, patterns), and caught once in the application's main. An inconsistent pattern, a fall or
// a solver that did not converge is a result and never an Error.

#include <stdexcept>
#include <string>
#include <utility>

namespace ayumi {

enum class ErrorCode {
  usage,        ///< the call itself is wrong (exit 2)
  bad_file,     ///< a file cannot be read, parsed or written (exit 3)
  bad_model,    ///< a robot description is not usable (exit 3)
  bad_pattern,  ///< a pattern does not make sense for its robot (exit 3)
  solver,       ///< an optimiser failed where an answer was needed (exit 4)
  internal      ///< a broken invariant of Ayumi itself (exit 5)
};

/// The subject of an error, for programs. The message alone says everything to people.
struct SourcePlace {
  std::string file = {};
  /// JSON pointer, or words for something that has no pointer; "" for the whole file.
  std::string inside = {};
  long line = 0;    ///< line, counted from 1; 0 if it is not known
  long column = 0;  ///< column, counted from 1; 0 if it is not known
  /// Whether the error names something that does not exist, so that changing a number cannot help.
  bool unknown_name = false;
  /// Whether the message already names the wrong value, so that a likely cause is only shown if it
  /// explains all errors.
  bool names_value = false;
  /// Whether the message already says what is wrong with the writing of the file, so that no
  /// general advice about it is added.
  bool names_remedy = false;

  bool empty() const { return file.empty() && inside.empty() && line == 0; }
};

/// The text "file:line:column: inside", without the parts that are not known.
std::string text_of(const SourcePlace& place);

/// A place within `place`: "/keyframes/3" and "/zmp" give "/keyframes/3/zmp".
SourcePlace operator+(SourcePlace place, const std::string& inside);

class Error : public std::runtime_error {
 public:
  /// `words` is the message without the file and the line at its beginning; if it is empty, the
  /// message has no such beginning.
  Error(ErrorCode code, const std::string& message, SourcePlace place = {}, std::string words = "")
      : std::runtime_error(message),
        code_(code),
        place_(std::move(place)),
        words_(words.empty() ? message : std::move(words)) {}
  ErrorCode code() const { return code_; }
  /// The message without the file and the line at its beginning.
  const std::string& words() const { return words_; }
  const SourcePlace& place() const { return place_; }

 private:
  ErrorCode code_;
  SourcePlace place_;
  std::string words_;
};

/// Long work was stopped by its progress callback (see progress.hpp); the application exits 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Throws Error(code, message) that concerns no file.
[[noreturn]] void fail(ErrorCode code, const std::string& message);

/// Throws Error(code, "place: what", place).
[[noreturn]] void fail(ErrorCode code, const SourcePlace& place, const std::string& what);

/// The words of an Error at `place`: the part of `place` inside the file, and then `what`.
std::string words_at(const SourcePlace& place, const std::string& what);

/// Throws Error(bad_pattern) for a pattern that names something that does not exist.
[[noreturn]] void fail_unknown_name(SourcePlace place, const std::string& what);

/// Throws `error` again with `more` at the end of its message; its code and place stay.
[[noreturn]] inline void throw_with_more(const Error& error, const std::string& more) {
  throw Error(error.code(), error.what() + more, error.place(), error.words() + more);
}

/// Calls `work`. If it throws an Error without a place, the Error gets this place; its message
/// stays.
template <typename Work>
auto at_place(SourcePlace place, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (!error.place().empty()) throw;
    place.unknown_name = error.place().unknown_name;
    place.names_value = error.place().names_value;
    place.names_remedy = error.place().names_remedy;
    throw Error(error.code(), error.what(), place);
  }
}

/// Throws Error(internal, message) unless `condition` holds. It is meant for invariants, not for
/// user input.
inline void require(bool condition, const char* message) {
  if (!condition) fail(ErrorCode::internal, message);
}

}  // namespace ayumi
