#pragma once
// The strict look at a URDF's XML before urdfdom reads it. Included by io/*.cpp only.

#include <map>
#include <set>
#include <string>

namespace ayumi {

/// What the check found and urdfdom does not report.
struct UrdfText {
  std::string xml;                         ///< repaired for urdfdom: unstated limits filled in
  std::map<std::string, int> link_place;   ///< place of each <link> in the file's order, by name
  std::map<std::string, int> joint_place;  ///< place of each <joint> in the file's order, by name
  std::set<std::string> unlimited;         ///< joints that state no position limits
};

/// Throws Error(bad_file) "file:line: what, remedy" for text that is not XML or not a URDF, unknown
/// joint types and geometries, numbers that are no finite numbers, links and joints without name,
/// and Error(bad_model) for wrong tree structure.
UrdfText check_urdf(const std::string& bytes, const std::string& file);

}  // namespace ayumi
