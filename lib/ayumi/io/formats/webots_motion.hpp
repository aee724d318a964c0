#pragma once
// Webots .motion: a head with the names of motors, then time, name of the pose and angles. V1.1 of
// the NAO teams has the names in a second line, % between the cells, and durations at the end of
// the rows in place of times.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_webots_motion(const MotionInput& source);
MotionFile read_webots_motion(const MotionInput& source);
std::vector<WrittenFile> write_webots_motion(const RobotModel& model, const MotionFile& motion);

/// V1.1 with `%` between the cells, the names in the second line, and as the last cell of a row the
/// time in which its pose is reached. Read by read_webots_motion.
std::string recognize_webots_durations(const MotionInput& source);
std::vector<WrittenFile> write_webots_durations(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
