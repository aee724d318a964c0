#pragma once
// The first sidecar of a robot that has only a URDF, for a person to correct. Every guess has a
// comment above it with its reason and with what to check.

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi {

struct FirstSidecar {
  std::string text;  ///< text of robot.json
  std::vector<std::string>
      to_do;               ///< points that a person should check or state, the most important first
  RobotDescription robot;  ///< the robot with the guesses
};

/// Gains of DTAD for a robot, which io cannot compute.
struct SidecarGains {
  std::vector<std::pair<std::string, double>> dtad;  ///< gains by name; empty: the default gains
  std::string why, check;                            ///< reason of the guess
  std::string to_do;                                 ///< point for the to-do list; "": nothing
};

/// `robot` is a file or folder as load_robot() takes it; the sidecar names its URDF relative to
/// `folder`, where the sidecar will be. Throws as load_robot(), and Error(usage) for a robot that
/// has a sidecar already. `gains` is called for the robot with the guesses, if it has soles.
FirstSidecar first_sidecar(const std::string& robot, const std::filesystem::path& folder,
                           const RobotSearch& search = {},
                           const std::function<SidecarGains(const RobotModel&)>& gains = {});

}  // namespace ayumi
