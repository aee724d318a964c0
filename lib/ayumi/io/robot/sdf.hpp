#pragma once
// RobotDescription from SDF, the format of Gazebo, versions 1.4 to 1.11: frames and poses relative
// to them, nested and included models. libsdformat is not used: it writes a log file into the
// user's home folder whenever it reads, and prints. Only files of io/robot include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Reads the model of the file, or the model of its world with the most joints. `path` is for
/// messages and for files that the model names. What cannot be kept is listed in `assumptions`.
/// Throws Error(bad_file) "file:line: ..." for a text that is not SDF, for unknown frames and for
/// frames in a circle, and Error(bad_model) for an impossible robot.
RobotDescription parse_sdf(const std::string& bytes, const std::filesystem::path& path,
                           const std::vector<std::filesystem::path>& packages);

}  // namespace ayumi
