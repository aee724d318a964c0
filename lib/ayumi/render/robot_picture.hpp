#pragma once
// A picture of a robot that stands in one posture.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/image.hpp"

namespace ayumi {

struct RobotPicture {
  Image image;
  std::vector<std::string> notes;  ///< notes about what is drawn differently from the robot's files
};

/// Draws the home posture, or the posture with the joint angles `theta` [rad]. With `marks`, the
/// picture has the outlines of the soles, the axes of the joints and an arrow ahead.
RobotPicture draw_robot(const RobotModel& model, const std::string& view, bool marks,
                        const Eigen::VectorXd* theta = nullptr);

}  // namespace ayumi
