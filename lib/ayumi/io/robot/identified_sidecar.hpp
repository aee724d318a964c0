#pragma once
// The servos that a recording shows, as a sidecar over that of the robot.

#include <string>

#include "ayumi/identify/identify.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct IdentifiedNames {
  std::string base;               ///< of the robot, as the new sidecar names it
  std::string name;               ///< of the new sidecar
  std::string command, measured;  ///< of the recordings
};

/// The text of the sidecar. Joints that did not move have the constants of their motor type.
std::string identified_sidecar(const RobotModel& model, const Identification& found,
                               const IdentifiedNames& names);

}  // namespace ayumi
