#pragma once
// A mesh from the bytes of a file, through assimp.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "ayumi/geometry/shape.hpp"

namespace ayumi::mesh_reader {

/// Why a file is no mesh, for people; the file is not named.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The bytes of a companion file, by its path relative to the folder of the mesh; empty: there is
/// none.
using AskFile = std::function<std::optional<std::string>(const std::string& path)>;

/// The mesh of the file `name` (without a folder; its extension says what it is) with these bytes,
/// as load_mesh() describes it. MeshPart::texture_file is as in an encoded mesh. Throws Refusal.
TriangleMesh import_mesh(const std::string& name, const std::string& bytes,
                         const Eigen::Vector3d& scale, const AskFile& ask);

}  // namespace ayumi::mesh_reader
