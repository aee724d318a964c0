#pragma once
// Curves of NAO's Choregraphe as XML (.qianim, and the timelines of behaviours). They contain keys
// of each actuator by frame, in degrees.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_qianim(const MotionInput& source);
MotionFile read_qianim(const MotionInput& source);
std::vector<WrittenFile> write_qianim(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
