#pragma once
// The servos that a recording shows, written as a sidecar with the robot as its base.

#include <string>

#include "ayumi/identify/identify.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct IdentifiedNames {
  std::string base;               ///< name of the robot, as the new sidecar states it
  std::string name;               ///< name of the new sidecar
  std::string command, measured;  ///< names of the recordings
};

/// The text of the sidecar. Joints that did not move have the constants of their motor type.
std::string identified_sidecar(const RobotModel& model, const Identification& found,
                               const IdentifiedNames& names);

}  // namespace ayumi
