#pragma once
// Checks whether a log belongs to a robot. Functions that draw a log or compute with it rely on
// this.

#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Throws Error(bad_file), beginning with `source`, if the joints of the log are not those of the
/// robot in the same order, or if an attitude is not a rotation.
void require_postures_of(const RobotModel& model, const SimulationLog& log,
                         const std::string& source);

/// Also throws if the COG of a sample is not that of the robot in this posture with the payloads
/// that it carries: then the log is of another robot, or was changed. The robot that a case of a
/// study has drawn is not known, so its COG is not compared.
void require_robot_of(const RobotModel& model, const SimulationLog& log, const std::string& source);

}  // namespace ayumi
