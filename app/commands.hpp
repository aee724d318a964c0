#pragma once
// The command line: one file per subcommand under commands/, listed once in commands.cpp.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "options.hpp"

namespace ayumi::app {

/// Options that mean the same everywhere, and how results and progress reach the user.
struct Context {
  bool json = false;
  bool quiet = false;
  bool force = false;
  int threads = 0;  ///< 0: all cores
  std::uint64_t seed = 1;
  std::vector<std::string> robot_path;    ///< folders searched for robots before the bundled ones
  std::vector<std::string> package_path;  ///< folders searched for the packages of meshes
  std::string command_line;               ///< as typed, without output paths

  /// Progress lines or bar on stderr; stops the work after Ctrl-C.
  Progress progress() const;
  /// Results for people, on stdout; nothing with --json.
  void print(const std::string& text) const;
  /// The result for --json: one object on stdout; nothing without --json.
  void print_json(const std::string& object) const;
  /// What a subcommand's callback sets: the process's exit status.
  int exit_code = 0;
};

/// Each adds one subcommand to `app`. Callbacks throw ayumi::Error for bad input.
using AddCommand = void (*)(Command& app, Context& context);

/// Where robots are looked for: --robot-path, then the bundled ones.
RobotSearch robot_search(const Context& context);

/// Folder of the bundled data ("robots", "patterns"): beside the installed program or in the
/// sources.
std::filesystem::path data_folder(const std::string& name);

int run(int argc, char** argv);

// Each defines add_<name> in commands/<name>.cpp; the list is commands/list.def.
#define AYUMI_COMMAND(name) void add_##name(Command& app, Context& context);
#include "commands/list.def"
#undef AYUMI_COMMAND

}  // namespace ayumi::app
