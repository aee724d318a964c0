#pragma once
// Motions as JSON: Poppy .move (degrees by time and motor), DeepMimic (rows of duration, root and
// joints, y up), and Open Duck (rows with named joints).

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_poppy_move(const MotionInput& source);
MotionFile read_poppy_move(const MotionInput& source);
std::vector<WrittenFile> write_poppy_move(const RobotModel& model, const MotionFile& motion);

std::string recognize_deep_mimic(const MotionInput& source);
/// "FrameDuration" beside the frames: root x y z, quaternion x y z w, joints, z up. Without it,
/// each frame begins with its duration, and has the quaternion w x y z, y up.
MotionFile read_deep_mimic(const MotionInput& source);
std::vector<WrittenFile> write_deep_mimic(const RobotModel& model, const MotionFile& motion);

std::string recognize_open_duck(const MotionInput& source);
MotionFile read_open_duck(const MotionInput& source);
std::vector<WrittenFile> write_open_duck(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
