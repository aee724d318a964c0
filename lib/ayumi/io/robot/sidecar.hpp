#pragma once
// Reads the sidecar robot.json into a description. Included by io/*.cpp only.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/robot/robot_inheritance.hpp"
#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// The description of the robot whose sidecar is `file`: URDF first, then the bases of the sidecar,
/// which `find` finds by name, then the sidecar over them. A URDF that is not where the sidecar
/// says is looked for in `folders`, and in their urdf/; `packages` are further folders with the
/// packages of its meshes. Throws Error(bad_file) "file: /pointer: what".
RobotDescription read_sidecar(const std::filesystem::path& file,
                              const std::vector<std::filesystem::path>& folders,
                              const std::vector<std::filesystem::path>& packages,
                              const FindRobot& find);

}  // namespace ayumi
