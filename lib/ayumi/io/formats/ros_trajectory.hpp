#pragma once
// Reads and writes trajectory_msgs/JointTrajectory as YAML, one or several, and reads the motions
// of play_motion2.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_ros_trajectory(const MotionInput& source);
/// Trajectories of the same joints follow each other in time; those of other joints run at the same
/// time.
MotionFile read_ros_trajectory(const MotionInput& source);
/// Writes the form of ROS 2, with sec and nanosec.
std::vector<WrittenFile> write_ros_trajectory(const RobotModel& model, const MotionFile& motion);

std::string recognize_play_motion(const MotionInput& source);
/// Reads the first motion of the file.
MotionFile read_play_motion(const MotionInput& source);
std::vector<WrittenFile> write_play_motion(const RobotModel& model, const MotionFile& motion);

}  // namespace ayumi
