#include "run_robot.hpp"

#include <filesystem>

#include "ayumi/base/error.hpp"

namespace ayumi::app {

RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options) {
  const bool elsewhere = chosen.empty() && recorded.find('/') != std::string::npos &&
                         !std::filesystem::exists(recorded);
  if (elsewhere)
    fail(ErrorCode::bad_file,
         recorded +
             ": no such file; the run names its robot by a path relative to the folder from which "
             "the run was made; start the command in that folder, or name the robot with --robot");
  return load_robot(chosen.empty() ? recorded : chosen, robot_search(context), options);
}

}  // namespace ayumi::app
