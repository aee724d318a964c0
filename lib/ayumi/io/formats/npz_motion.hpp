#pragma once
// Motions as NumPy archives. Archives for tracking (BeyondMimic, mjlab, AMASS for G1) have fps,
// joint_pos, joint_vel, and the poses and velocities of the bodies in the world. Archives of GMR
// have fps, root_pos, root_rot and dof_pos.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_tracking_npz(const MotionInput& source);
MotionFile read_tracking_npz(const MotionInput& source);
/// The names of joints and bodies are written beside the arrays of the format.
std::vector<WrittenFile> write_tracking_npz(const RobotModel& model, const MotionFile& motion);
/// The archive of `motion` without the first and the last row, which only serve to compute the
/// rates of their neighbours. The function is for the rows of a cycle if the rows before and after
/// the cycle are known.
std::string tracking_npz_within(const RobotModel& model, const MotionFile& motion);

std::string recognize_gmr_npz(const MotionInput& source);
MotionFile read_gmr_npz(const MotionInput& source);
std::vector<WrittenFile> write_gmr_npz(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
