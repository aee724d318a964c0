#pragma once
// Triangle meshes from files (STL, OBJ with MTL, COLLADA, glTF, PLY). They are read by the program
// ayumi-mesh-reader, a child process with limits, so that a broken or hostile file at worst ends
// that process.

#include <Eigen/Core>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/geometry/shape.hpp"
#include "ayumi/io/robot/mesh_cache.hpp"

namespace ayumi {

/// The resources that reading one mesh may use, and the program that reads it.
struct MeshReading {
  std::filesystem::path program;  ///< path of the program; if it is empty, find_mesh_reader()
  /// Memory for reading in addition to that of the reader itself: a base [bytes], and a number of
  /// bytes for each byte of the mesh file and of its companions. Chosen: binary STL needs the most
  /// memory, 12 bytes for each byte.
  std::uint64_t base_memory = std::uint64_t{256} << 20, memory_per_byte = 64;
  /// Largest processor time [s]. Chosen: the largest meshes of 5 million triangles take a third of
  /// it.
  std::uint64_t cpu_time = 60;
  /// Largest total time [s], whatever the reader does. Chosen: on a machine with other work, a
  /// reader has half of the processor.
  double time = 120;
  /// Largest number of bytes of an answer. Chosen: 5 million triangles with three vertices of their
  /// own each take 0.54 GB; the rest is for textures.
  std::uint64_t answer_size = std::uint64_t{1} << 30;
  /// Folder in which answers of the reader are kept (mesh_cache.hpp); no value for none.
  std::optional<std::filesystem::path> cache = MeshCache::usual_folder();
};

/// The mesh at `path`. Node transforms are applied, COLLADA's unit is converted to metres, every
/// vertex is multiplied by `scale` (a mirroring scale turns the triangles so that they still face
/// outwards), and missing normals are computed. The file's axes are the link's axes: a COLLADA up
/// axis is ignored, as URDF tools do. A texture inside the file is "data:" with its bytes in
/// MeshPart::texture_file. Companion files (the materials of OBJ in .mtl, the buffers of glTF in
/// .bin) are searched by names relative to the folder of the mesh; no other files are opened.
/// Throws Error(bad_file) that names the file if it is missing, cannot be read as a mesh, has no
/// triangle, more than 5 million triangles or a vertex that is not finite, if reading needs more
/// memory or time than `reading` allows, or if the reader crashed or gave an invalid answer. Throws
/// Error(bad_file) that names ayumi-mesh-reader if this program is missing or cannot be started.
TriangleMesh load_mesh(const std::filesystem::path& path,
                       const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                       const MeshReading& reading = {});

struct MeshRequest {
  std::filesystem::path path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< as in load_mesh()
};

/// The reason why a mesh of several could not be read: the first failure in their order.
struct MeshFailure {
  size_t request = 0;  ///< index of the mesh
  /// Error that load_mesh() throws for it; empty if all meshes were read.
  std::exception_ptr error;
};

/// Several meshes as load_mesh() reads them, in the order of `requests`, by at most four readers
/// side by side. The same files give the same bytes. After a failure, all further meshes are empty.
/// The calling thread calls `progress` repeatedly.
std::vector<TriangleMesh> load_meshes(const std::vector<MeshRequest>& requests,
                                      MeshFailure& failure, const MeshReading& reading = {},
                                      const Progress& progress = {});

}  // namespace ayumi
