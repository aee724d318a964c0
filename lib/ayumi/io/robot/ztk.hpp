#pragma once
// Robots of mi-lib (.ztk of RoKi): tags with fields, read and written. Included by io/*.cpp only.

#include <filesystem>
#include <string>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Links with their joints, masses, motors and shapes. A joint has the name of its link. `path` is
/// for messages and for meshes. What cannot be kept is listed in `assumptions`. Throws
/// Error(bad_file) "file:line: ..." for what is no chain, Error(bad_model) for an impossible robot.
RobotDescription parse_ztk(const std::string& bytes, const std::filesystem::path& path);

/// The same robot for RoKi: links in the order of the joints, as .zvs files hold them. A link that
/// a joint moves has the joint's name, and z along its axis. Meshes are triangles; what RoKi cannot
/// hold (mimic joints) is left out.
std::string ztk_text(const RobotDescription& robot, const std::vector<std::string>& joint_order);

}  // namespace ayumi
