#pragma once
// Reads the sidecar robot.json into a description. Included by io/*.cpp only.

#include <filesystem>
#include <string>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// The description of the robot whose sidecar is `file`: URDF first, then the sidecar over it.
/// Throws Error(bad_file) "file: /pointer: what".
RobotDescription read_sidecar(const std::filesystem::path& file);

}  // namespace ayumi
