#pragma once
// Robots by name or by file. A robot is a folder robots/<name> with robot.json (the sidecar) and
// its URDF, a sidecar alone, or a bare URDF whose soles, servos and home posture are inferred. The
// sidecar is specified in docs/formats.md, "Robot sidecar".

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Folders that are searched for robots in this order (each robot is a folder with a robot.json),
/// and folders that hold the packages of meshes.
struct RobotSearch {
  std::vector<std::filesystem::path> folders;
  std::vector<std::filesystem::path> packages = {};  ///< where "package://NAME/..." is looked for
};

struct LoadOptions {
  /// Whether the meshes of visuals are loaded, too; those of collisions always are.
  bool meshes = false;
  bool guess = true;       ///< whether values are inferred that the files do not state
  Progress progress = {};  ///< is called while meshes are read
};

struct RobotEntry {
  std::string name;
  std::filesystem::path sidecar;
};

/// The robots in the search folders by name; an earlier folder hides a later one.
std::vector<RobotEntry> find_robots(const RobotSearch& search);

/// `name_or_path`: a name in the search folders, a folder, a robot.json, or a URDF. Inferred values
/// are listed in `assumptions`. Throws Error(bad_file) if there is no such robot or a file cannot
/// be read, and "file: /pointer: ..." for a sidecar that is not as specified; throws
/// Error(bad_model) for an impossible robot.
RobotDescription load_robot_description(const std::string& name_or_path,
                                        const RobotSearch& search = {},
                                        const LoadOptions& options = {});

/// The assumption about soles that were inferred (SoleDescription::source), in words; empty if both
/// soles are stated. The sidecar of `init` has inferred soles, too, and marks them.
std::string inferred_soles(const RobotDescription& robot);

/// The robot of load_robot_description() as a validated model.
RobotModel load_robot(const std::string& name_or_path, const RobotSearch& search = {},
                      const LoadOptions& options = {});

}  // namespace ayumi
