#pragma once
// Reads the sidecar robot.json into a description. Included by io/*.cpp only.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// The description of the robot whose sidecar is `file`: URDF first, then the sidecar over it.
/// A URDF that is not where the sidecar says is looked for in `folders`, and in their urdf/. Throws
/// Error(bad_file) "file: /pointer: what".
RobotDescription read_sidecar(const std::filesystem::path& file,
                              const std::vector<std::filesystem::path>& folders = {});

}  // namespace ayumi
