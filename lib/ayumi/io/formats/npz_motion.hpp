#pragma once
// Motions as NumPy archives. Tracking (BeyondMimic, mjlab, AMASS for G1): fps, joint_pos, joint_vel
// and the poses and velocities of the bodies in the world. GMR: fps, root_pos, root_rot, dof_pos.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_tracking_npz(const MotionInput& source);
MotionFile read_tracking_npz(const MotionInput& source);
/// With the names of joints and bodies beside the arrays of the format.
std::vector<WrittenFile> write_tracking_npz(const RobotModel& model, const MotionFile& motion);
/// The same without the first and the last row, from which only the rates of their neighbours
/// follow: the rows of a cycle, of which those before and behind it are known.
std::string tracking_npz_within(const RobotModel& model, const MotionFile& motion);

std::string recognize_gmr_npz(const MotionInput& source);
MotionFile read_gmr_npz(const MotionInput& source);
std::vector<WrittenFile> write_gmr_npz(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
