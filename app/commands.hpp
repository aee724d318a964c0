#pragma once
// The command line: one file per subcommand under commands/, listed once in commands.cpp.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"

namespace ayumi::app {

/// Options that mean the same everywhere, and how results and progress reach the user.
struct Context {
  bool json = false;
  bool quiet = false;
  bool force = false;
  int threads = 0;                        ///< 0: all cores
  std::uint64_t seed = 1;
  std::vector<std::string> robot_path;    ///< folders searched for robots before the bundled ones
  std::string command_line;               ///< as typed, without output paths

  /// Progress lines or bar on stderr; stops the work after Ctrl-C.
  Progress progress() const;
  /// What a subcommand's callback sets: the process's exit status.
  int exit_code = 0;
};

/// Each adds one subcommand to `app`. Callbacks throw ayumi::Error for bad input.
using AddCommand = void (*)(CLI::App& app, Context& context);

int run(int argc, char** argv);

}  // namespace ayumi::app
