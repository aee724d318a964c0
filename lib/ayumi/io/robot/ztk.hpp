#pragma once
// Robots of mi-lib (.ztk of RoKi), which are read and written. Their text has tags with fields.
// In the library, only files below io include it.

#include <filesystem>
#include <string>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Reads links with their joints, masses, motors and shapes. A joint has the name of its link.
/// `path` is for messages and for meshes. What cannot be kept is listed in `assumptions`. Throws
/// Error(bad_file) "file:line: ..." for a text that is not a chain, and Error(bad_model) for an
/// impossible robot.
RobotDescription parse_ztk(const std::string& bytes, const std::filesystem::path& path);

/// The text of `robot` for RoKi: its links have the order of the joints, as .zvs files have it. A
/// link that a joint moves has the joint's name, and its z is along the joint's axis. Meshes become
/// triangles. What RoKi cannot represent (mimic joints) is left out.
std::string ztk_text(const RobotDescription& robot, const std::vector<std::string>& joint_order);

}  // namespace ayumi
