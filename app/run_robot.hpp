#pragma once
// The robot of a run.

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// `chosen` by --robot, or else the one that the run recorded. Throws as load_robot; where a
/// recorded path does not lead to a robot from here, Error(bad_file) says so and names --robot.
RobotModel robot_of_run(const Context& context, const std::string& chosen,
                        const std::string& recorded, const LoadOptions& options = {});

/// A log must fit its robot: Error(bad_file), beginning with `source`, says that the joints are
/// others, that an attitude is no rotation, that the recorded robot is not the one any more that
/// made the log, or that the COG of the log is not that robot's. A robot that `chosen` names may
/// differ in everything but its joints.
void require_log_of(const RobotModel& model, const std::string& chosen, const SimulationLog& log,
                    const std::string& source);

/// The robot of a log, which fits it.
RobotModel robot_of_log(const Context& context, const std::string& chosen, const SimulationLog& log,
                        const std::string& source, const LoadOptions& options = {});

}  // namespace ayumi::app
