#pragma once
// HOAP sequences (io/formats/hoap.hpp) as motions. General commands (3) only take their time. If
// intervals change, rows are interpolated linearly on the greatest common divisor of the intervals.
// Rows without an interval have the interval of their layout, or the rate that the user states.
// Rows of radians have the signs of the encoders unless the user says otherwise.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_hoap_motion(const MotionInput& source);
/// Throws Error(bad_file) as parse_hoap() does, and if a device moves that the robot does not have.
MotionFile read_hoap_motion(const MotionInput& source);

}  // namespace ayumi
