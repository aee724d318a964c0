#pragma once
// Merges a sidecar with its base: {"base": "hoap1", ...} contains only the differences. Objects are
// merged by key, profiles are merged by name, and the lists of groups are appended, so that the
// later group counts. Everything else is replaced. Only files of io/robot include it.

#include <filesystem>
#include <functional>
#include <string>

#include "ayumi/io/json/json_reader.hpp"

namespace ayumi {

/// A sidecar merged with all its bases.
struct MergedSidecar {
  Json document;      ///< the document without "base"
  JsonPlaces places;  ///< the place of each value in the files
  std::string bytes;  ///< bytes of all files, the last base first

  JsonNode root() const { return {document, "", "", ErrorCode::bad_file, &places}; }
};

/// The file of a robot with this name. Throws Error if there is none.
using FindRobot = std::function<std::filesystem::path(const std::string&)>;

/// Reads `file` and its bases. A base is a path relative to the file that names it, or a name that
/// `find` finds. A URDF counts as a sidecar without further keys. Throws Error(bad_file) for a file
/// that is not a sidecar, for a base that does not exist, and for bases in a circle.
MergedSidecar read_merged_sidecar(const std::filesystem::path& file, const FindRobot& find);

}  // namespace ayumi
