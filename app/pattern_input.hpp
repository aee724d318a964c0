#pragma once
// What every command that takes a PATTERN shares: reading it, its robot, and sampling it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ayumi/task/task.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// Options of a PATTERN argument.
struct PatternOptions {
  std::vector<std::string> set;  ///< "name=value" for declared parameters
  std::string profile;           ///< actuator profile; "" = the pattern's, then the robot's default
  std::string robot = {};        ///< in place of the pattern's; "" = the pattern's
};
void add_pattern_options(Command& command, PatternOptions& options);

/// `--times` of the pushes of a study; none: those that fit the motion.
void add_push_times(Command& command, std::vector<double>& times);

/// The bytes of a file; `-` is standard input. Throws Error(bad_file) for more than `most` bytes.
std::string read_input(const std::filesystem::path& file, size_t most = size_t{1} << 30);

/// The pattern of a file; `-` is standard input, what it names is then looked for in the working
/// folder. A file that is not there, with a folder before its name ("patterns/hoap1_walk.json"), is
/// looked for in the bundled data.
Pattern read_given_pattern(const std::filesystem::path& file,
                           const std::map<std::string, double>& set = {});

/// Reads the pattern (as read_given_pattern) and its robot and samples it at the robot's servo
/// period.
Task load_pattern(const Context& context, const std::filesystem::path& file,
                  const PatternOptions& options, bool meshes = false);

/// The robot as a pattern names it. A path in the working folder gets a slash, which a bundled name
/// does not have.
std::string robot_as_written(const std::string& robot);

/// Those of the task, with `overrides` ("kind=value") over the tolerances of its pattern.
CheckOptions check_options(const Task& input, const std::vector<std::string>& overrides);

/// Throws Error(usage) for an override that no kind of finding has.
void refuse_unknown_tolerances(const std::vector<std::string>& overrides);

/// "name=value" pairs. Throws Error(usage) naming the option and the word.
std::map<std::string, double> read_pairs(const std::vector<std::string>& words,
                                         const std::string& option);

/// Throws Error(bad_file) when `path` exists and --force was not given, and where no regular file
/// can be written (require_file_target).
void refuse_overwriting(const Context& context, const std::filesystem::path& path);

}  // namespace ayumi::app
