#include "ayumi/io/task_file.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/io/kept_rows.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

// The rows that `export` would write. If a kept sequence is missing or was changed, this is an
// error of `export` only.
std::optional<ReferenceTrajectory> kept_targets(const Task& task) {
  try {
    if (std::optional<KeptRows> kept = kept_rows(task)) return std::move(kept->targets);
  } catch (const Error&) {
  }
  return {};
}

}  // namespace

Task load_task(Pattern pattern, const TaskOptions& options, const Progress& progress) {
  const std::string name = options.robot.empty() ? robot_of(pattern) : options.robot;
  RobotModel robot = [&] {
    try {
      return load_robot(name, options.robots, {.meshes = options.meshes, .progress = progress});
    } catch (const Error& error) {
      if (!options.robot.empty() || error.code() != ErrorCode::bad_file) throw;
      const SourcePlace names = in_file(pattern, "/robot");
      throw Error(error.code(), text_of(names) + ": " + error.what(),
                  error.place().empty() ? names : error.place(), words_at(names, error.what()));
    }
  }();
  return load_task(std::move(pattern), {std::move(robot), name}, options.profile, progress,
                   options.threads);
}

Task load_task(Pattern pattern, NamedRobot robot, const std::string& profile,
               const Progress& progress, int threads) {
  TableCaution caution = caution_of(pattern);
  Task task = make_task(std::move(pattern), std::move(robot.model), profile, progress, threads);
  task.robot_name = robot.name;
  task.caution = std::move(caution);
  task.series.kept = kept_targets(task);
  return task;
}

Task load_task(const std::filesystem::path& pattern, const TaskOptions& options,
               const Progress& progress) {
  return load_task(read_pattern(pattern, options.set), options, progress);
}

}  // namespace ayumi
