#pragma once
// The picture of a robot as a file.

#include <string>
#include <vector>

#include "ayumi/render/robot_picture.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// Writes the robot in its home posture, without marks. Throws Error(usage) for a name that does
/// not end in .png.
std::vector<std::string> write_robot_picture(const Context& context, const RobotModel& model,
                                             const std::string& file, const std::string& view);

}  // namespace ayumi::app
