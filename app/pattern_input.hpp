#pragma once
// What every command that takes a PATTERN shares: reading it, its robot, and sampling it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ayumi/check/judge.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/table_caution.hpp"
#include "ayumi/sim/simulate.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// Options of a PATTERN argument.
struct PatternOptions {
  std::vector<std::string> set;  ///< "name=value" for declared parameters
  std::string profile;           ///< actuator profile; "" = the pattern's, then the robot's default
  std::string robot = {};        ///< in place of the pattern's; "" = the pattern's
};
void add_pattern_options(CLI::App& command, PatternOptions& options);

struct PatternInput {
  Pattern pattern;
  RobotModel model;
  CommandSeries series;
  std::string profile;        ///< by name
  TableCaution caution = {};  ///< of the run that the pattern's table is from
};

/// The bytes of a file; `-` is standard input.
std::string read_input(const std::filesystem::path& file);

/// The pattern of a file; `-` is standard input, what it names is then looked for in the working
/// folder.
Pattern read_given_pattern(const std::filesystem::path& file,
                           const std::map<std::string, double>& set = {});

/// Throws Error(bad_pattern) naming file and place for disturbances on links or joints that the
/// robot does not have, and for unknown gains and tolerances.
void check_against_robot(const Pattern& pattern, const RobotModel& model);

/// The pattern at the robot's servo period. Throws as sample().
CommandSeries sample_at_servo_period(const RobotModel& model, const Pattern& pattern,
                                     const Progress& progress = {});

/// Reads the pattern (as read_given_pattern) and its robot and samples it at the robot's servo
/// period.
PatternInput load_pattern(const Context& context, const std::filesystem::path& file,
                          const PatternOptions& options, bool meshes = false);

/// What a user calls a robot, for a pattern: a path in the working folder is told from a bundled
/// name by its slash.
std::string robot_as_written(const std::string& robot);

/// The pattern's own tolerances over the defaults, `overrides` ("kind=value") over both.
CheckOptions check_options(const PatternInput& input,
                           const std::vector<std::string>& overrides = {});

/// The verdict on the pattern: the one that check, run, simulate and export give.
Judgement judge_pattern(const PatternInput& input, const CheckOptions& options);

Provenance provenance(const Context& context, const PatternInput& input,
                      const std::string& controller);

/// "name=value" pairs. Throws Error(usage) naming the option and the word.
std::map<std::string, double> read_pairs(const std::vector<std::string>& words,
                                         const std::string& option);

/// Throws Error(bad_file) when `path` exists and --force was not given, and where no regular file
/// can be written (require_file_target).
void refuse_overwriting(const Context& context, const std::filesystem::path& path);

}  // namespace ayumi::app
