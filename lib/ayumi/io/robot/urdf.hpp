#pragma once
// Makes a RobotDescription from a URDF file. urdfdom reads the file after a strict check here,
// because urdfdom accepts "nan" and incomplete numbers, and does not name the line of an error.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Reads the links and joints of the URDF in `bytes`. `path` is for messages and for finding
/// meshes, and `packages` are further folders with packages. Meshes are found but not loaded;
/// missing ones are left out and listed in `assumptions` (MeshPlaces). Throws Error(bad_file)
/// "file:line: ..." for a text that is not a URDF, and Error(bad_model) for an impossible robot.
RobotDescription parse_urdf(const std::string& bytes, const std::filesystem::path& path,
                            const std::vector<std::filesystem::path>& packages = {});

}  // namespace ayumi
