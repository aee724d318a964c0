#pragma once
// The command line. Each subcommand has one file under commands/ and is listed once in
// commands.cpp.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "options.hpp"

namespace ayumi::app {

/// Options that mean the same for all commands, and the functions by which results and progress
/// reach the user.
struct Context {
  bool json = false;
  bool quiet = false;
  bool force = false;
  int threads = 0;  ///< number of threads; 0: all cores
  std::uint64_t seed = 1;
  /// Folders that are searched for robots before the bundled ones.
  std::vector<std::string> robot_path;
  std::vector<std::string> package_path;  ///< folders that are searched for the packages of meshes
  std::string command_line;               ///< the command line as typed, without output paths

  /// Reports progress as lines or a bar on stderr, and stops the work after Ctrl-C.
  Progress progress() const;
  /// Prints results for people on stdout; prints nothing with --json.
  void print(const std::string& text) const;
  /// Prints the result for --json: one object on stdout; prints nothing without --json.
  void print_json(const std::string& object) const;
  /// The exit status of the process, which a subcommand's callback sets.
  int exit_code = 0;
};

/// A function that adds one subcommand to `app`. Callbacks throw ayumi::Error for bad input.
using AddCommand = void (*)(Command& app, Context& context);

/// The folders that are searched for robots: those of --robot-path, then the bundled ones.
RobotSearch robot_search(const Context& context);

/// The folder of the bundled data `name` ("robots", "patterns"), beside the installed program or in
/// the sources.
std::filesystem::path data_folder(const std::string& name);

int run(int argc, char** argv);

// Each file commands/<name>.cpp defines add_<name>; the list is commands/list.def.
#define AYUMI_COMMAND(name) void add_##name(Command& app, Context& context);
#include "commands/list.def"
#undef AYUMI_COMMAND

}  // namespace ayumi::app
