#pragma once
// Finds the meshes that a robot's file names. Missing meshes are remembered, so that all of them
// can be listed at once. Only files of io/robot include it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

class MeshPlaces {
 public:
  /// `robot_file` names the meshes; `packages` are the folders of --package-path.
  MeshPlaces(std::filesystem::path robot_file, std::vector<std::filesystem::path> packages)
      : robot_file_(std::move(robot_file)), packages_(std::move(packages)) {}

  /// The file of a mesh that `link` names: relative to the robot's file, as "file://", or as
  /// "package://NAME/..." and "model://NAME/...". A package is a folder of this name, or a folder
  /// whose package.xml has this name. It is searched among `packages` and the folders in them, and
  /// then in the folder of the robot's file, in the folders above it and beside those. A file whose
  /// name differs only in upper and lower case is accepted. Empty if there is no such file.
  std::string find(const std::string& link, const std::string& name);

  /// The folder "model://NAME" or "package://NAME"; empty if there is none.
  std::filesystem::path folder(const std::string& name) const { return named_file(name); }

  /// Notes for a person: every mesh that was used although its name differs.
  std::vector<std::string> notes() const;

  /// Every mesh that is missing, with its link.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::filesystem::path named_file(const std::string& name) const;

  std::filesystem::path robot_file_;
  std::vector<std::filesystem::path> packages_;
  std::vector<std::string> missing_, renamed_;  ///< each name once
};

}  // namespace ayumi
