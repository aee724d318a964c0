#pragma once
// BodyMotion of Choreonoid (.seq, .yaml), versions 1 to 4.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_body_motion(const MotionInput& source);
MotionFile read_body_motion(const MotionInput& source);
/// Writes version 4.
std::vector<WrittenFile> write_body_motion(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
