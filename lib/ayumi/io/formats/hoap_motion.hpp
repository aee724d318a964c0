#pragma once
// HOAP sequences (io/formats/hoap.hpp) as motions. General commands (rows with the code 3) are
// ignored, but the time of their rows counts. If intervals change, rows are interpolated linearly
// on the greatest common divisor of the intervals. Rows without an interval have the interval of
// their layout, or the rate that the user states. Rows of radians have the signs of the encoders
// unless the user says otherwise.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_hoap_motion(const MotionInput& source);
/// Throws the same errors as parse_hoap(), and Error(bad_file) if a device moves that the robot
/// does not have.
MotionFile read_hoap_motion(const MotionInput& source);

}  // namespace ayumi
