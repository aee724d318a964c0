#pragma once
// Reads key postures in a table whose first row has the times and whose other rows have one joint
// each.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_transposed_csv(const MotionInput& source);
MotionFile read_transposed_csv(const MotionInput& source);
std::vector<WrittenFile> write_transposed_csv(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
