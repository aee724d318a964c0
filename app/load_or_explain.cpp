#include "load_or_explain.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi::app {

namespace {

[[noreturn]] void explain(const Context& context, const Error& error, const std::string& file,
                          const PatternOptions& options,
                          const std::vector<std::string>& tolerances) {
  const Pattern pattern = read_given_pattern(file, read_pairs(options.set, "--set"));
  const RobotModel robot = load_robot(robot_of(pattern), robot_search(context));
  CheckOptions judged;
  judged.profile = options.profile.empty() ? pattern.profile : options.profile;
  judged.tolerances = pattern.tolerances;
  for (const auto& [kind, value] : read_pairs(tolerances, "--tolerance"))
    judged.tolerances[kind] = value;
  judged.threads = context.threads;
  judged.degrees = pattern.degrees;
  std::vector<Mistake> mistakes = likely_mistakes(robot, pattern, judged, context.progress());
  try {
    sample_at_servo_period(robot, pattern, {}, context.threads);
  } catch (const Error& first) {
    if (first.place().names_value)
      std::erase_if(mistakes, [](const Mistake& mistake) { return !mistake.explains_all; });
    throw with_mistakes(first, pattern, mistakes);
  }
  throw error;  // an error that no sample shows
}

}  // namespace

Task load_or_explain(const Context& context, const std::string& file, const PatternOptions& options,
                     const std::vector<std::string>& tolerances) {
  try {
    return load_pattern(context, file, options);
  } catch (const Error& error) {
    const bool is_of_numbers = error.code() == ErrorCode::bad_pattern &&
                               !error.place().unknown_name && !error.place().names_remedy;
    if (!is_of_numbers || file == "-") throw;
    explain(context, error, file, options, tolerances);
  }
}

}  // namespace ayumi::app
