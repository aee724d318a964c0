#pragma once
// Functions for all commands that take a PATTERN: they read it and its robot, and sample it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ayumi/task/task.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// Options of a PATTERN argument.
struct PatternOptions {
  std::vector<std::string> set;  ///< "name=value" for each declared parameter that is set
  /// Actuator profile; "" for that of the pattern, or else the robot's default.
  std::string profile;
  std::string robot = {};  ///< the robot; "" for that of the pattern
};
void add_pattern_options(Command& command, PatternOptions& options);

/// The option `--times` for the pushes of a study. Without it, the times are those that suit the
/// motion.
void add_push_times(Command& command, std::vector<double>& times);

/// The bytes of a file; `-` is standard input. Throws Error(bad_file) for more than `most` bytes.
std::string read_input(const std::filesystem::path& file, size_t most = size_t{1} << 30);

/// The pattern of a file; `-` is standard input, and then the files that the pattern names are
/// searched in the working folder. A file that does not exist but is named with a folder
/// ("patterns/hoap1_walk.json") is searched in the bundled data. `text` receives the text of the
/// pattern, which standard input gives only once.
Pattern read_given_pattern(const std::filesystem::path& file,
                           const std::map<std::string, double>& set = {},
                           std::string* text = nullptr);

/// Reads the pattern (as read_given_pattern) and its robot and samples it at the robot's servo
/// period.
Task load_pattern(const Context& context, const std::filesystem::path& file,
                  const PatternOptions& options, bool meshes = false, std::string* text = nullptr);

/// The robot in the form in which a pattern names it. A path in the working folder gets a slash,
/// which a bundled name does not have.
std::string robot_as_written(const std::string& robot);

/// The check options of the task. `overrides` ("kind=value") replace tolerances of its pattern.
CheckOptions check_options(const Task& input, const std::vector<std::string>& overrides);

/// Throws Error(usage) for an override whose kind does not exist.
void refuse_unknown_tolerances(const std::vector<std::string>& overrides);

/// Reads "name=value" pairs. Throws Error(usage) that names the option and the word.
std::map<std::string, double> read_pairs(const std::vector<std::string>& words,
                                         const std::string& option);

/// Throws Error(bad_file) if `path` exists and --force was not given, and if no regular file can be
/// written there (require_file_target).
void refuse_overwriting(const Context& context, const std::filesystem::path& path);

}  // namespace ayumi::app
