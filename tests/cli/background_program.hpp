#pragma once
// Runs the real program in the background, to stop it by a signal.

#include <chrono>
#include <functional>
#include <thread>

#include "tests/cli/program.hpp"

namespace ayumi::test {

/// Starts `program arguments…` in `folder`, without streams, and does not wait for it.
inline pid_t start(const std::vector<std::string>& arguments, const fs::path& folder) {
  const ArgumentVector argv(program_under_test(), arguments);
  const pid_t child = ::fork();
  if (child == 0) {
    const int nothing = ::open("/dev/null", O_RDWR);
    if (::chdir(folder.c_str()) != 0 || ::dup2(nothing, 1) < 0 || ::dup2(nothing, 2) < 0)
      ::_exit(126);
    argv.execute();
    ::_exit(127);
  }
  return child;
}

/// Whether the condition becomes true within `seconds`.
inline bool holds_within(double seconds, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace ayumi::test
