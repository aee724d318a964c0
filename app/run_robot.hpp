#pragma once
// The robot of a run.

#include "ayumi/io/robot/robot_file.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// `chosen` by --robot, or else the one that the run recorded. Throws as load_robot; where a
/// recorded path does not lead to a robot from here, Error(bad_file) says so and names --robot.
RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options = {});

}  // namespace ayumi::app
