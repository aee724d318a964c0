#pragma once
// Reads the sidecar robot.json into a description. Only files of io/robot include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/robot/robot_inheritance.hpp"
#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// The description of the robot whose sidecar is `file`. The URDF is read first, then the bases of
/// the sidecar, which `find` finds by name, and then the sidecar, which overrides them. If a URDF
/// is not where the sidecar says, it is searched in `folders` and in their subfolders urdf/.
/// `packages` are further folders with the packages of its meshes. Throws Error(bad_file) "file:
/// /pointer: what".
RobotDescription read_sidecar(const std::filesystem::path& file,
                              const std::vector<std::filesystem::path>& folders,
                              const std::vector<std::filesystem::path>& packages,
                              const FindRobot& find);

}  // namespace ayumi
