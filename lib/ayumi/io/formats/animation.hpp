#pragma once
// Motions that are written only: BVH for animation programs, and keyframes of a MuJoCo model.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

/// Centimetres, y up, z forward; one joint for each body, rotations in the order z, x, y.
std::vector<WrittenFile> write_bvh(const RobotModel& model, const MotionFile& motion);

/// qpos: root x y z, quaternion w x y z, joints in the robot's order.
std::vector<WrittenFile> write_mujoco_keys(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
