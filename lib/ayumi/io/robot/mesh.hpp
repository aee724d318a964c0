#pragma once
// Triangle meshes from files (STL, OBJ with MTL, COLLADA, glTF, PLY), through assimp.

#include <Eigen/Core>
#include <filesystem>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// The mesh at `path`: node transforms applied, COLLADA's unit converted to metres, every vertex
/// multiplied by `scale` (a mirroring scale turns the triangles so that they still face outwards),
/// missing normals made. The file's axes are the link's axes: a COLLADA up axis is ignored, as URDF
/// tools do. A texture that the file carries
/// inside itself is "data:" with its bytes in MeshPart::texture_file. Throws Error(bad_file) naming
/// the file: missing, not readable as a mesh, no triangle, more than 5 million triangles, a vertex
/// that is not finite.
TriangleMesh load_mesh(const std::filesystem::path& path,
                       const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace ayumi
