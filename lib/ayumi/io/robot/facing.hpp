#pragma once
// Ayumi's robots look along x of their root link. Where a URDF's robot looks along another axis,
// the frame of the root link is turned, and everything that is stated in this frame with it.
// Included by io/*.cpp only.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// "x", "y", "-x", "-y".
const std::vector<std::string>& facing_names();

/// Unit vector in the URDF's root link. Throws Error(internal) for another name.
Eigen::Vector3d facing_direction(const std::string& facing);

/// Turns the frame of the root link about z so that its x is the `facing` of before. No body moves
/// against another.
void turn_to_face_x(RobotDescription& robot, const std::string& facing);

}  // namespace ayumi
