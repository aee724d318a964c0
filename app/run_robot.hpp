#pragma once
// The robot of a run.

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// The robot that `chosen` (--robot) names, or else the one that the run recorded. Throws as
/// load_robot. If a recorded path does not lead to a robot from here, Error(bad_file) says this and
/// names --robot.
RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options = {});

/// Throws Error(bad_file), beginning with `source`, if the log does not fit its robot: the joints
/// differ, an attitude is not a rotation, the recorded robot has changed since the log was made, or
/// the COG of the log is not that of the robot. A robot that `chosen` names only needs to have the
/// same joints.
void require_log_of(const RobotModel& model, const std::string& chosen, const SimulationLog& log,
                    const std::string& source);

/// The robot of a log. The log has been tested to fit it.
RobotModel robot_of_log(const Context& context, const std::string& chosen, const SimulationLog& log,
                        const std::string& source, const LoadOptions& options = {});

}  // namespace ayumi::app
