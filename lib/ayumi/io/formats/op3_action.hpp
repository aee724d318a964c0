#pragma once
// Action files of ROBOTIS OP3 (.bin): 256 pages of 512 bytes, each with up to 7 steps. A step has
// 31 positions in the order of the servos' numbers (a turn is 4096, and 2048 is at angle 0), a
// pause and a time.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_op3_action(const MotionInput& source);
/// Reads the first page with steps and the pages that follow it. Servos are the robot's devices
/// ("encoders" of its sidecar). Other servos are named, for example, "ID 5"; a sidecar may have an
/// alias for this name.
MotionFile read_op3_action(const MotionInput& source);
std::vector<WrittenFile> write_op3_action(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
