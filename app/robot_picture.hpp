#pragma once
// A picture of a robot that stands in its home posture.

#include <string>
#include <vector>

#include "ayumi/render/image.hpp"
#include "commands.hpp"

namespace ayumi::app {

struct RobotPicture {
  Image image;
  std::vector<std::string> notes;  ///< what is drawn otherwise than the robot's files say
};

/// In its home posture, or at the joint angles `theta` [rad]. `marks`: with the outlines of the
/// soles, the axes of the joints and an arrow ahead.
RobotPicture draw_robot(const RobotModel& model, const std::string& view, bool marks,
                        const Eigen::VectorXd* theta = nullptr);

/// Writes it without marks. Throws Error(usage) for a name that does not end in .png.
std::vector<std::string> write_robot_picture(const Context& context, const RobotModel& model,
                                             const std::string& file, const std::string& view);

}  // namespace ayumi::app
