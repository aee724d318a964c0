#pragma once
// The strict check of a URDF's XML before urdfdom reads it. Only files of io/robot include it.

#include <map>
#include <set>
#include <string>

namespace ayumi {

/// Results of the check that urdfdom does not report.
struct UrdfText {
  std::string xml;  ///< the text with unstated limits filled in, as urdfdom needs it
  std::map<std::string, int> link_place;   ///< place of each <link> in the file's order, by name
  std::map<std::string, int> joint_place;  ///< place of each <joint> in the file's order, by name
  std::set<std::string> unlimited;         ///< joints that state no position limits
};

/// Throws Error(bad_file) "file:line: what, remedy" for a text that is not XML or not a URDF, for
/// unknown types of joints and geometries, for numbers that are not finite, and for links and
/// joints without a name. Throws Error(bad_model) if links and joints are not a tree.
UrdfText check_urdf(const std::string& bytes, const std::string& file);

}  // namespace ayumi
