#include "pattern_input.hpp"

#include <charconv>

#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern_file.hpp"
#include "ayumi/pattern/sample.hpp"

namespace ayumi::app {

void add_pattern_options(CLI::App& command, PatternOptions& options) {
  command.add_option("--set", options.set, "a parameter the pattern declares, as NAME=VALUE")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command.add_option("--profile", options.profile, "actuator profile of the robot")
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
        std::from_chars(word.data() + equals + 1, end, value).ptr != end)
      fail(ErrorCode::usage, option + ": '" + word + "' is not NAME=NUMBER");
    pairs[word.substr(0, equals)] = value;
  }
  return pairs;
}

PatternInput load_pattern(const Context& context, const std::filesystem::path& file,
                          const PatternOptions& options, bool meshes) {
  Pattern pattern = read_pattern(file, read_pairs(options.set, "--set"));
  RobotModel model = load_robot(robot_of(pattern), robot_search(context), {.meshes = meshes});
  const std::string wanted = options.profile.empty() ? pattern.profile : options.profile;
  const std::string profile = model.limits(wanted).name;
  CommandSeries series =
      sample(model, pattern, {.dt = model.description().servo_period}, context.progress());
  return {std::move(pattern), std::move(model), std::move(series), profile};
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

Provenance provenance(const Context& context, const PatternInput& input,
                      const std::string& controller) {
  return {.robot = input.pattern.robot,
          .robot_sha256 = input.model.description().sha256,
          .pattern = input.pattern.name,
          .pattern_sha256 = input.pattern.sha256,
          .profile = input.profile,
          .controller = controller,
          .command_line = context.command_line};
}

void refuse_overwriting(const Context& context, const std::filesystem::path& path) {
  if (!context.force && std::filesystem::exists(path))
    fail(ErrorCode::bad_file, path.string() + ": exists already; choose another name or --force");
}

}  // namespace ayumi::app
