#pragma once
// Errors that name a place and a remedy. Thrown at the edges of the library (files, models,
// patterns), caught once in the application's main. An inconsistent pattern, a fall or a solver
// that did not converge is a result, never an Error.

#include <stdexcept>
#include <string>

namespace ayumi {

enum class ErrorCode {
  usage,        ///< the call itself is wrong (exit 2)
  bad_file,     ///< a file cannot be read, parsed or written (exit 3)
  bad_model,    ///< a robot description is not usable (exit 3)
  bad_pattern,  ///< a pattern does not make sense for its robot (exit 3)
  solver,       ///< an optimiser failed where an answer was needed (exit 4)
  internal      ///< a broken invariant of Ayumi itself (exit 5)
};

class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// Long work was stopped by its progress callback (see progress.hpp); the application exits 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Throws Error(code, message).
[[noreturn]] void fail(ErrorCode code, const std::string& message);

/// Throws Error(internal, message) unless `condition` holds. For invariants, not for user input.
inline void require(bool condition, const char* message) {
  if (!condition) fail(ErrorCode::internal, message);
}

}  // namespace ayumi
