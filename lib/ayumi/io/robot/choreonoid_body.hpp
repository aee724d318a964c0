#pragma once
// RobotDescription from a Choreonoid body file (.body, YAML). Only files of io/robot include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Reads links with their joints, masses and shapes; the joint ids give the order of the joints.
/// `path` is for messages and for meshes. What cannot be kept is listed in `assumptions`. Throws
/// Error(bad_file) "file:line: ..." for a text that is not a body file, and Error(bad_model) for an
/// impossible robot.
RobotDescription parse_choreonoid_body(const std::string& bytes, const std::filesystem::path& path,
                                       const std::vector<std::filesystem::path>& packages);

}  // namespace ayumi
