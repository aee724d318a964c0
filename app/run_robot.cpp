#include "run_robot.hpp"

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/io/run/log_robot.hpp"

namespace ayumi::app {

RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options) {
  const bool elsewhere = chosen.empty() && recorded.find('/') != std::string::npos &&
                         !std::filesystem::exists(recorded);
  if (elsewhere)
    fail(ErrorCode::bad_file, recorded +
                                  ": no such file. The run names its robot by a path that is "
                                  "relative to the folder in which the run was started. Start the "
                                  "command in that folder, or name the robot with --robot");
  return load_robot(chosen.empty() ? recorded : chosen, robot_search(context), options);
}

void require_log_of(const RobotModel& model, const std::string& chosen, const SimulationLog& log,
                    const std::string& source) {
  require_postures_of(model, log, source);
  if (!chosen.empty()) return;
  const std::string& made_with = log.provenance.robot_sha256;
  if (!made_with.empty() && made_with != model.description().sha256)
    fail(ErrorCode::bad_file, {source},
         "the robot '" + model.name() +
             "' has changed since the run was made. Make the run again, or give --robot to use the "
             "present robot");
  require_robot_of(model, log, source);
}

RobotModel robot_of_log(const Context& context, const std::string& chosen, const SimulationLog& log,
                        const std::string& source, const LoadOptions& options) {
  RobotModel model = robot_of_run(context, chosen, log.provenance.robot, options);
  require_log_of(model, chosen, log, source);
  return model;
}

}  // namespace ayumi::app
