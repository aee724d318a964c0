#include "pattern_input.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <iterator>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi::app {

void add_pattern_options(CLI::App& command, PatternOptions& options) {
  command.add_option("--set", options.set, "Set a parameter that the pattern declares.")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--profile", options.profile,
                  "Actuator profile of the robot (default: the pattern's).")
      ->type_name("NAME");
}

std::map<std::string, double> read_pairs(const std::vector<std::string>& words,
                                         const std::string& option) {
  std::map<std::string, double> pairs;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    double value = 0;
    const char* end = word.data() + word.size();
    if (equals == std::string::npos || equals == 0 ||
        std::from_chars(word.data() + equals + 1, end, value).ptr != end || !std::isfinite(value))
      fail(ErrorCode::usage, option + ": '" + word + "' is not NAME=NUMBER");
    pairs[word.substr(0, equals)] = value;
  }
  return pairs;
}

namespace {

// A push on a link that is not there is told before anything is computed.
void check_scenario(const Pattern& pattern, const RobotModel& model) {
  std::vector<std::string> links = {"cog"};
  for (const Link& link : model.links()) links.push_back(link.name);
  const std::vector<std::string> joints = model.dof_names();
  for (size_t i = 0; i < pattern.scenario.size(); ++i) {
    const Disturbance& d = pattern.scenario[i];
    const std::string place = pattern.file + ": /scenario/" + std::to_string(i);
    if (std::find(links.begin(), links.end(), d.on) == links.end())
      fail(ErrorCode::bad_pattern, place + "/on: " + model.name() + " has no link '" + d.on + "'" +
                                       text::suggestion(d.on, links) +
                                       "; 'cog' pushes through the centre of gravity");
    if (!d.joint.empty() && std::find(joints.begin(), joints.end(), d.joint) == joints.end())
      fail(ErrorCode::bad_pattern, place + "/joint: " + model.name() + " has no joint '" + d.joint +
                                       "'" + text::suggestion(d.joint, joints));
  }
}

// What the library calls wrong use is bad input where a file says it.
template <class Check>
void check_words(const std::string& place, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    fail(ErrorCode::bad_pattern, place + ": " + error.what());
  }
}

void check_gains_and_tolerances(const Pattern& pattern, const RobotModel& model) {
  check_words(model.description().sidecar_file + ": /control",
              [&] { check_controller(model, {.type = pattern.controller.type, .gains = {}}); });
  check_words(pattern.file + ": /controller", [&] { check_controller(model, pattern.controller); });
  check_words(pattern.file + ": /tolerances",
              [&] { tolerances({.tolerances = pattern.tolerances}); });
}

}  // namespace

void check_against_robot(const Pattern& pattern, const RobotModel& model) {
  check_scenario(pattern, model);
  check_gains_and_tolerances(pattern, model);
}

std::string read_input(const std::filesystem::path& file) {
  if (file != "-") return read_file(file);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

Pattern read_given_pattern(const std::filesystem::path& file,
                           const std::map<std::string, double>& set) {
  if (file != "-") return read_pattern(file, set);
  return pattern_of_text(read_input(file), "standard input", set);
}

CommandSeries sample_at_servo_period(const RobotModel& model, const Pattern& pattern,
                                     const Progress& progress) {
  return sample(model, pattern, {.dt = model.description().servo_period}, progress);
}

PatternInput load_pattern(const Context& context, const std::filesystem::path& file,
                          const PatternOptions& options, bool meshes) {
  Pattern pattern = read_given_pattern(file, read_pairs(options.set, "--set"));
  RobotModel model = load_robot(options.robot.empty() ? robot_of(pattern) : options.robot,
                                robot_search(context), {.meshes = meshes});
  check_against_robot(pattern, model);
  const std::string wanted = options.profile.empty() ? pattern.profile : options.profile;
  const std::string profile = model.limits(wanted).name;
  CommandSeries series = sample_at_servo_period(model, pattern, context.progress());
  TableCaution caution = caution_of(pattern);
  return {std::move(pattern), std::move(model), std::move(series), profile, std::move(caution)};
}

std::string robot_as_written(const std::string& robot) {
  const bool here = robot.find('/') == std::string::npos && std::filesystem::exists(robot);
  return here ? "./" + robot : robot;
}

CheckOptions check_options(const PatternInput& input, const std::vector<std::string>& overrides) {
  CheckOptions options;
  options.profile = input.profile;
  options.friction = input.pattern.world.friction;
  options.tolerances = input.pattern.tolerances;
  for (const auto& [kind, value] : read_pairs(overrides, "--tolerance"))
    options.tolerances[kind] = value;
  return options;
}

Judgement judge_pattern(const PatternInput& input, const CheckOptions& options) {
  return judge(input.model, input.series,
               keyed_goals(input.model, input.series, input.pattern.controller), options);
}

Provenance provenance(const Context& context, const PatternInput& input,
                      const std::string& controller) {
  return {.robot = robot_of(input.pattern),  // holds from the working folder
          .robot_sha256 = input.model.description().sha256,
          .pattern = input.pattern.name,
          .pattern_sha256 = input.pattern.sha256,
          .profile = input.profile,
          .controller = controller,
          .command_line = context.command_line};
}

void refuse_overwriting(const Context& context, const std::filesystem::path& path) {
  require_file_target(path);
  if (!context.force) refuse_existing(path);
}

}  // namespace ayumi::app
