#pragma once
// Motions as CSV without a head row, as LAFAN1 for Unitree G1 and robot_motion_editor have them:
// root x y z [m], quaternion x y z w, joints [rad].

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_motion_csv(const MotionInput& source);
MotionFile read_motion_csv(const MotionInput& source);
std::vector<WrittenFile> write_motion_csv(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
