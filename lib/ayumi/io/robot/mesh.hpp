#pragma once
// Triangle meshes from files (STL, OBJ with MTL, COLLADA, glTF, PLY). The program ayumi-mesh-reader
// reads them, a child process with limits: a broken or hostile file ends that process at worst.

#include <Eigen/Core>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/geometry/shape.hpp"

namespace ayumi {

/// The resources that reading one mesh may use, and the program that reads it.
struct MeshReading {
  std::filesystem::path program;  ///< empty: find_mesh_reader()
  /// Memory beside the reader itself: a base [bytes], and as much for each byte of the mesh file
  /// and of its companions. Chosen: the greediest format, binary STL, takes 12 bytes for each byte.
  std::uint64_t base_memory = std::uint64_t{256} << 20, memory_per_byte = 64;
  /// Time of the processor [s]. Chosen: the largest meshes of 5 million triangles take a third.
  std::uint64_t cpu_time = 60;
  /// Time altogether [s], whatever the reader does. Chosen: on a machine with other work, a reader
  /// has half of the processor.
  double time = 120;
  /// Most bytes of an answer. Chosen: 5 million triangles with three vertices of their own each
  /// take 0.54 GB; the rest is for textures.
  std::uint64_t answer_size = std::uint64_t{1} << 30;
};

/// The mesh at `path`: node transforms applied, COLLADA's unit converted to metres, every vertex
/// multiplied by `scale` (a mirroring scale turns the triangles so that they still face outwards),
/// missing normals made. The file's axes are the link's axes: a COLLADA up axis is ignored, as URDF
/// tools do. A texture that the file carries inside itself is "data:" with its bytes in
/// MeshPart::texture_file. Companion files (the materials of OBJ in .mtl, the buffers of glTF in
/// .bin) are found by names relative to the folder of the mesh; others are not opened. Throws
/// Error(bad_file) naming the file: missing, not readable as a mesh, no triangle, more than 5
/// million triangles, a vertex that is not finite, more memory or time than `reading` allows, a
/// reader that crashed or gave an answer that is not valid; and naming ayumi-mesh-reader where it
/// is missing or cannot be started.
TriangleMesh load_mesh(const std::filesystem::path& path,
                       const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                       const MeshReading& reading = {});

struct MeshRequest {
  std::filesystem::path path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< as in load_mesh()
};

/// The reason why a mesh of several could not be read: the first failure in their order.
struct MeshFailure {
  size_t request = 0;        ///< index of the mesh
  std::exception_ptr error;  ///< error that load_mesh() throws for it; empty: all meshes were read
};

/// Several meshes as load_mesh() reads them, in the order of `requests`, by at most four readers
/// side by side. The same files give the same bytes. After a failure, all further meshes are empty.
/// `progress` is asked by the calling thread all the time.
std::vector<TriangleMesh> load_meshes(const std::vector<MeshRequest>& requests,
                                      MeshFailure& failure, const MeshReading& reading = {},
                                      const Progress& progress = {});

}  // namespace ayumi
