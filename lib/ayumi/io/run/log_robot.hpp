#pragma once
// Whether a log is one of a robot: whoever draws a log or computes with it trusts this.

#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Throws Error(bad_file), beginning with `source`, where the joints of the log are others than
/// those of the robot, or in another order, or where an attitude is no rotation.
void require_postures_of(const RobotModel& model, const SimulationLog& log,
                         const std::string& source);

/// The same, and where the COG of a sample is not that of the robot in this posture with the
/// payloads that it carries: the log is of another robot, or was changed. The robot that a case of
/// a study drew is not known, so there the COG is not compared.
void require_robot_of(const RobotModel& model, const SimulationLog& log, const std::string& source);

}  // namespace ayumi
