#pragma once
// The formats to which motions are only written: BVH for animation programs, and keyframes of a
// MuJoCo model.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

/// Writes BVH. Lengths are in centimetres, y is up and z is forward. There is one joint for each
/// body, with its rotations in the order z, x, y.
std::vector<WrittenFile> write_bvh(const RobotModel& model, const MotionFile& motion);

/// Writes keyframes of a MuJoCo model. qpos is the position x y z of the root, its quaternion w x y
/// z, and the joints in the robot's order.
std::vector<WrittenFile> write_mujoco_keys(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
