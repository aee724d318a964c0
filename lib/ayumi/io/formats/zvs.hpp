#pragma once
// Sequences of joint displacements of mi-lib (.zvs): "dt n ( v1 ... vn )" in each line. Where the
// root floats, its position and rotation vector come first. The joints have the names of the robot
// (.ztk) of the same name beside the motion, where there is one.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_zvs(const MotionInput& source);
MotionFile read_zvs(const MotionInput& source);
std::vector<WrittenFile> write_zvs(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
