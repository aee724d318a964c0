#include "run_robot.hpp"

#include <filesystem>

#include "ayumi/base/error.hpp"

namespace ayumi::app {

RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options) {
  const bool elsewhere = chosen.empty() && recorded.find('/') != std::string::npos &&
                         !std::filesystem::exists(recorded);
  if (elsewhere)
    fail(ErrorCode::bad_file, recorded +
                                  ": no such file; a run names its robot as seen from the folder "
                                  "where it was made; go there, or name it by --robot");
  return load_robot(chosen.empty() ? recorded : chosen, robot_search(context), options);
}

}  // namespace ayumi::app
