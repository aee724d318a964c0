#pragma once
// RobotDescription from a URDF file. Read through urdfdom after a strict check of our own, since
// urdfdom takes "nan" and half-numbers, and names no line.

#include <filesystem>
#include <string>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Links and joints of the URDF at `path`; meshes are resolved to existing files but not loaded.
/// Mesh names may be relative to the URDF, "file://", or "package://NAME/...", which is looked for
/// in the URDF's folder and those above it (a folder NAME, or a package.xml that names NAME).
/// Throws Error(bad_file) "file:line: ..." for what is not a URDF, Error(bad_model) for an
/// impossible robot.
RobotDescription read_urdf(const std::filesystem::path& path);

/// The same from `bytes`; `path` is for messages and for resolving meshes.
RobotDescription parse_urdf(const std::string& bytes, const std::filesystem::path& path);

}  // namespace ayumi
