#pragma once
// Motions as JSON: Poppy .move (degrees by time and motor), DeepMimic (rows of duration, root and
// joints, y up), and Open Duck (rows with named joints).

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_poppy_move(const MotionInput& source);
MotionFile read_poppy_move(const MotionInput& source);
std::vector<WrittenFile> write_poppy_move(const RobotModel& model, const MotionFile& motion);

std::string recognize_deep_mimic(const MotionInput& source);
/// With "FrameDuration" beside the frames, a frame has the root x y z, the quaternion x y z w and
/// the joints, and z is up. Without it, each frame begins with its duration, has the quaternion w x
/// y z, and y is up.
MotionFile read_deep_mimic(const MotionInput& source);
std::vector<WrittenFile> write_deep_mimic(const RobotModel& model, const MotionFile& motion);

std::string recognize_open_duck(const MotionInput& source);
MotionFile read_open_duck(const MotionInput& source);
std::vector<WrittenFile> write_open_duck(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
