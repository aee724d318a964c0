#pragma once
// The first sidecar of a robot that has a URDF only, for a person to correct: every guess stands
// under a comment with its reason and with what to check.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi {

struct FirstSidecar {
  std::string text;                ///< robot.json
  std::vector<std::string> to_do;  ///< what a person should check or state, most important first
  RobotDescription robot;          ///< with the guesses
};

/// `robot` is a file or folder as load_robot() takes it; the sidecar names its URDF relative to
/// `folder`, where the sidecar will be. Throws as load_robot(), and Error(usage) for a robot that
/// has a sidecar already.
FirstSidecar first_sidecar(const std::string& robot, const std::filesystem::path& folder,
                           const RobotSearch& search = {});

}  // namespace ayumi
