#pragma once
// Answers of ayumi-mesh-reader about mesh files that it has read before, in the user's cache
// folder. An entry belongs to the bytes of the mesh file and of its companions, and not to a path
// or a time, so a changed file never gets the answer about the old one. The folder may be deleted
// at any time. A problem with it (a full disk, no permission, a broken entry) is never an error:
// the mesh is then read as if there were no cache.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/io/robot/mesh_message.hpp"

namespace ayumi {

/// Largest number of companion files of one mesh. Chosen: an OBJ has one, a glTF a handful.
inline constexpr size_t kMostMeshCompanions = 64;

/// The bytes of a companion file of a mesh, by the name that the mesh states; no value if there is
/// no such file.
using CompanionBytes = std::function<std::optional<std::string>(const std::string& name)>;

/// A companion file that the reader asked for.
struct AskedCompanion {
  std::string name;    ///< as the mesh states it
  std::string sha256;  ///< of its bytes; empty if there is no such file
};

class MeshCache {
 public:
  /// Largest number of bytes of all entries together. Chosen: the meshes of about twenty robots.
  /// The oldest entries are deleted first.
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{512} << 20;
  /// A larger answer is not kept. Chosen: it would displace many others.
  static constexpr size_t kLargestAnswer = size_t{64} << 20;

  /// The folder ayumi/meshes in $XDG_CACHE_HOME or, without this variable, in $HOME/.cache. No
  /// value if the path in the variable is not absolute, or if neither variable is set.
  static std::optional<std::filesystem::path> usual_folder();

  /// Without a folder, nothing is found and nothing is kept.
  explicit MeshCache(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

  /// The name under which the answer to a request is kept: a hash of everything that the reader
  /// gets with the request (scale, limits, name and bytes of the file), and of the reader itself.
  static std::string key_of(const MeshRequestHead& request, const std::string& file_name,
                            std::string_view bytes, const std::filesystem::path& reader);

  /// The kept answer, if all companions that the reader asked for then are the same now.
  std::optional<std::string> find(const std::string& key, const CompanionBytes& companion) const;

  void keep(const std::string& key, const std::vector<AskedCompanion>& companions,
            const std::string& answer) const;

 private:
  void remove_oldest() const;

  std::optional<std::filesystem::path> folder_;
};

}  // namespace ayumi
