#pragma once
// Ayumi's robots look along x of their root link. If the robot of a URDF looks along another axis,
// the frame of the root link is turned, together with everything that is stated in this frame.
// Only files of io/robot include it.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// The names of the directions: "x", "y", "-x", "-y".
const std::vector<std::string>& facing_names();

/// The direction of this name as a unit vector in the URDF's root link. Throws Error(internal) for
/// another name.
Eigen::Vector3d facing_direction(const std::string& facing);

/// Turns the frame of the root link about z so that its x axis is the former `facing`. The bodies
/// do not move relative to each other.
void turn_to_face_x(RobotDescription& robot, const std::string& facing);

}  // namespace ayumi
