#include "pattern_input.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/task_file.hpp"

namespace ayumi::app {

void add_pattern_options(Command& command, PatternOptions& options) {
  command.add_option("--set", options.set, "Set a parameter that the pattern declares.")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--profile", options.profile,
                  "Actuator profile of the robot (default: the profile of the pattern).")
      ->type_name("NAME");
}

void add_push_times(Command& command, std::vector<double>& times) {
  command
      .add_option("--times", times,
                  "Times of the pushes [s] (default: chosen from the pattern). Each push is a "
                  "simulation of its own. A walk has five times by default: one while the robot "
                  "stands, and four during one step. If VIIP plans the steps, there are three "
                  "times, all during one step. A motion without steps has two times: one while the "
                  "robot stands, and the middle of the motion.")
      ->type_name("T")
      ->delimiter(',');
}

std::map<std::string, double> read_pairs(const std::vector<std::string>& words,
                                         const std::string& option) {
  std::map<std::string, double> pairs;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    double value = 0;
    const char* end = word.data() + word.size();
    std::from_chars_result read{nullptr, std::errc::invalid_argument};
    if (equals != std::string::npos && equals > 0)
      read = std::from_chars(word.data() + equals + 1, end, value);
    const bool cannot_hold = read.ec == std::errc::result_out_of_range;
    if (read.ptr != end || (read.ec != std::errc() && !cannot_hold))
      fail(ErrorCode::usage, option + ": '" + word + "' does not have the form NAME=NUMBER");
    if (cannot_hold)
      fail(ErrorCode::usage,
           option + ": the number of '" + word +
               "' is too large or too near to 0. Give 0, or a number from -1e6 to 1e6");
    if (!(std::abs(value) <= kLargestNumber))
      fail(ErrorCode::usage,
           option + ": '" + word + "' is out of range. The number must be from -1e6 to 1e6");
    pairs[word.substr(0, equals)] = value;
  }
  return pairs;
}

std::string read_input(const std::filesystem::path& file, size_t most) {
  if (file != "-") return read_file(file, most);
  std::string bytes;
  std::array<char, 65536> block;
  while (std::cin.read(block.data(), block.size()), std::cin.gcount() > 0) {
    bytes.append(block.data(), static_cast<size_t>(std::cin.gcount()));
    if (bytes.size() > most)
      fail(ErrorCode::bad_file, "standard input: more than " + std::to_string(most) +
                                    " bytes came. An input of this kind may have at most " +
                                    std::to_string(most));
  }
  return bytes;
}

namespace {

/// A file that does not exist here, such as "patterns/hoap1_walk.json", may be bundled with Ayumi.
std::filesystem::path file_or_bundled(const std::filesystem::path& file) {
  std::error_code ignored;
  if (file.is_absolute() || !file.has_parent_path() || std::filesystem::exists(file, ignored))
    return file;
  const std::filesystem::path bundled =
      data_folder(*file.begin()) / file.lexically_relative(*file.begin());
  return std::filesystem::is_regular_file(bundled, ignored) ? bundled : file;
}

}  // namespace

Pattern read_given_pattern(const std::filesystem::path& file,
                           const std::map<std::string, double>& set, std::string* text) {
  if (file != "-") {
    const std::filesystem::path found = file_or_bundled(file);
    Pattern pattern = read_pattern(found, set);
    if (text) *text = read_input(found, kLargestPattern);
    return pattern;
  }
  const std::string words = read_input(file, kLargestPattern);
  if (text) *text = words;
  return pattern_of_text(words, "standard input", set);
}

Task load_pattern(const Context& context, const std::filesystem::path& file,
                  const PatternOptions& options, bool meshes, std::string* text) {
  const TaskOptions chosen = {.profile = options.profile,
                              .robot = options.robot,
                              .robots = robot_search(context),
                              .meshes = meshes,
                              .threads = context.threads};
  return load_task(read_given_pattern(file, read_pairs(options.set, "--set"), text), chosen,
                   context.progress());
}

std::string robot_as_written(const std::string& robot) {
  const bool here = robot.find('/') == std::string::npos && std::filesystem::exists(robot);
  return here ? "./" + robot : robot;
}

CheckOptions check_options(const Task& input, const std::vector<std::string>& overrides) {
  CheckOptions options = ayumi::check_options(input);
  for (const auto& [kind, value] : read_pairs(overrides, "--tolerance"))
    options.tolerances[kind] = value;
  return options;
}

void refuse_unknown_tolerances(const std::vector<std::string>& overrides) {
  CheckOptions options;
  options.tolerances = read_pairs(overrides, "--tolerance");
  tolerances(options);
}

void refuse_overwriting(const Context& context, const std::filesystem::path& path) {
  require_file_target(path);
  if (!context.force) refuse_existing(path);
}

}  // namespace ayumi::app
