#pragma once
// Key postures with time along the first row and one row per joint.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_transposed_csv(const MotionInput& source);
MotionFile read_transposed_csv(const MotionInput& source);
std::vector<WrittenFile> write_transposed_csv(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
