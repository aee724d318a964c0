#include "plan_log.hpp"

#include <filesystem>

#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/task/plan_log.hpp"

namespace ayumi::app {

bool names_pattern(const std::string& file) {
  const std::filesystem::path path(file);
  return (path.extension() == ".json" || path.extension() == ".jsonc") &&
         std::filesystem::is_regular_file(path) && path.filename() != "run.json";
}

SimulationLog log_of(const Context& context, const std::string& run_or_pattern,
                     const std::string& log) {
  if (!names_pattern(run_or_pattern)) return read_run_log(run_or_pattern, log);
  const Task input = load_pattern(context, run_or_pattern, {});
  SimulationLog plan =
      plan_log(input.robot, input.robot.limits(input.profile), input.series, input.series);
  plan.provenance = provenance(input, "", context.command_line);
  plan.provenance.pattern = std::filesystem::path(run_or_pattern).stem().string();
  plan.world = input.pattern.world;
  return plan;
}

}  // namespace ayumi::app
