#pragma once
// A mesh from the bytes of a file, through assimp.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "ayumi/geometry/shape.hpp"

namespace ayumi::mesh_reader {

/// The reason why a file is not a mesh, for people. It does not name the file.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the bytes of a companion file, whose path is relative to the folder of the mesh; empty
/// if there is none.
using AskFile = std::function<std::optional<std::string>(const std::string& path)>;

/// The mesh of the file `name` with these bytes, as load_mesh() describes it. The name has no
/// folder, and its extension gives the format. MeshPart::texture_file is as in an encoded mesh.
/// Throws Refusal.
TriangleMesh import_mesh(const std::string& name, const std::string& bytes,
                         const Eigen::Vector3d& scale, const AskFile& ask);

}  // namespace ayumi::mesh_reader
