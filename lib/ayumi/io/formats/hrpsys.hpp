#pragma once
// Files of the hrpsys SequencePlayer: .pos and, beside it, .zmp, .waist, .hip and .torque, with the
// time in the first column. The ZMP is in the frame of the waist.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_hrpsys(const MotionInput& source);
MotionFile read_hrpsys(const MotionInput& source);
std::vector<WrittenFile> write_hrpsys(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
