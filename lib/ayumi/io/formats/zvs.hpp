#pragma once
// Sequences of joint displacements of mi-lib (.zvs): each line is "dt n ( v1 ... vn )". If the root
// floats, its position and rotation vector come first. If there is a robot (.ztk) of the same name
// beside the motion, the joints have the names of this robot.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_zvs(const MotionInput& source);
MotionFile read_zvs(const MotionInput& source);
std::vector<WrittenFile> write_zvs(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
