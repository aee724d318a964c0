#pragma once
// The links and joints of a robot from a file of any format that Ayumi reads. In the library, only
// files below io include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

enum class RobotFormat { sidecar, urdf, mjcf, sdf, body, ztk };

/// The format of a robot's file, recognized by its content. The name decides only if the content
/// does not show the format. Throws Error(bad_file) for any other file, and says what the file is
/// if this can be recognized.
RobotFormat robot_format(const std::string& bytes, const std::filesystem::path& path);

/// The links and joints of a file that is not a sidecar. `packages` are further folders with the
/// packages of meshes. Throws the same errors as the readers of the formats, Error(bad_file) and
/// Error(bad_model).
RobotDescription parse_robot(const std::string& bytes, const std::filesystem::path& path,
                             const std::vector<std::filesystem::path>& packages);

/// Whether the ending of a file's name may be that of a robot, in upper or lower case.
bool has_robot_ending(const std::filesystem::path& path);

}  // namespace ayumi
