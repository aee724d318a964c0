#pragma once
// RobotDescription from a URDF file. Read through urdfdom after a strict check of our own, since
// urdfdom takes "nan" and half-numbers, and names no line.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Links and joints of the URDF in `bytes`; `path` is for messages and for resolving meshes, and
/// `packages` are further folders with packages. Meshes are resolved to existing files but not
/// loaded; those that are missing are left out and listed in `assumptions` (MeshPlaces). Throws
/// Error(bad_file) "file:line: ..." for what is not a URDF, Error(bad_model) for an impossible
/// robot.
RobotDescription parse_urdf(const std::string& bytes, const std::filesystem::path& path,
                            const std::vector<std::filesystem::path>& packages = {});

}  // namespace ayumi
