#pragma once
// Webots .motion files. They have a head with the names of motors, and rows with a time, the name
// of a pose and angles. The version V1.1 of the NAO teams has the names in a second line, % between
// the cells, and durations at the end of the rows instead of times.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_webots_motion(const MotionInput& source);
MotionFile read_webots_motion(const MotionInput& source);
std::vector<WrittenFile> write_webots_motion(const RobotModel& model, const MotionFile& motion);

/// The version V1.1, with `%` between the cells and the names in the second line. The last cell of
/// a row is the duration of the motion to its pose. read_webots_motion() also reads this version.
std::string recognize_webots_durations(const MotionInput& source);
std::vector<WrittenFile> write_webots_durations(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
