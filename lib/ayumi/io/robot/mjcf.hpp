#pragma once
// Makes a RobotDescription from MJCF, MuJoCo's own format. MuJoCo compiles the model, so that its
// own rules apply (default classes, frames, inertias from shapes), and the compiled tree is read
// back. MuJoCo only gets text that was read and cleaned here, and no file: it places the meshes,
// but they are read in the same way as those of other formats. Only files of io/robot include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Reads bodies, joints, inertias, geoms, position actuators, force limits, joint equalities (as
/// mimic joints), excluded contacts and the site of the inertial unit. `path` is for messages and
/// for files that the model names. What cannot be kept is listed in `assumptions`. Throws
/// Error(bad_file) for a text that is not MJCF, Error(bad_model) with MuJoCo's words for an
/// impossible model, and Error(bad_file) with a remedy if Ayumi was built without MuJoCo.
RobotDescription parse_mjcf(const std::string& bytes, const std::filesystem::path& path,
                            const std::vector<std::filesystem::path>& packages);

}  // namespace ayumi
