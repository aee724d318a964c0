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
  std::vector<std::string> notes;  ///< what is drawn otherwise than the robot's files say
};

/// In its home posture, or at the joint angles `theta` [rad]. `marks`: with the outlines of the
/// soles, the axes of the joints and an arrow ahead.
RobotPicture draw_robot(const RobotModel& model, const std::string& view, bool marks,
                        const Eigen::VectorXd* theta = nullptr);

}  // namespace ayumi
