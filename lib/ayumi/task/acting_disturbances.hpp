#pragma once
// Finds the disturbances that act on the robot at the same time, and their consequences for the
// check of a motion with payloads and changes of friction.

#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/scenario.hpp"
#include "ayumi/sim/payload.hpp"

namespace ayumi {

/// Whether there is an instant at which both disturbances act.
bool act_together(const Disturbance& a, const Disturbance& b);

/// The payloads of the scenario that are carried while `acting` acts, `acting` itself included, in
/// the order of the scenario. Payloads on links that the robot does not have are left out.
std::vector<CarriedMass> masses_carried_while(const Disturbance& acting,
                                              const std::vector<Disturbance>& scenario,
                                              const RobotModel& robot);

/// The errors of the report `loaded`, made while `acting` acts, that the report `plain` without it
/// does not have. Errors of commands are left out, because the commands are those of the robot
/// alone, and the controller compensates for the difference.
std::vector<Finding> errors_brought_by(const Disturbance& acting, const ConsistencyReport& loaded,
                                       const ConsistencyReport& plain);

}  // namespace ayumi
