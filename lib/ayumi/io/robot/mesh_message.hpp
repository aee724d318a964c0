#pragma once
// The messages between Ayumi and the program ayumi-mesh-reader. Both run on the same machine, so
// that numbers have its byte order.
//
// The reader first sends the message `hello`. Then the following steps are repeated: Ayumi sends a
// request; the reader asks for companion files, each of which Ayumi answers with a file; the reader
// sends a mesh or a refusal. The reader ends when the connection is closed.
//
// A message is a head and `size` bytes:
//   hello    nothing; the number `version` is in `size`
//   request  MeshRequestHead, the name of the file, the bytes of the file
//   ask      the path of a companion file, relative to the folder of the mesh
//   file     nothing if there is no such file, otherwise one byte (1) and the bytes of the file
//   mesh     what encode_mesh() makes
//   refusal  the reason why the file is not a mesh, for people
//   memory   nothing: reading took more memory than the request allows

#include <cstdint>
#include <string>
#include <string_view>

#include "ayumi/geometry/shape.hpp"

namespace ayumi {

constexpr std::uint64_t kMeshMessageVersion = 1;

enum class MeshMessage : std::uint32_t {
  hello =
      0x4d595901,  ///< not a small number, so that another program is not mistaken for the reader
  request,
  ask,
  file,
  mesh,
  refusal,
  memory
};

struct MeshMessageHead {
  MeshMessage kind = MeshMessage::refusal;
  std::uint32_t unused = 0;
  std::uint64_t size = 0;  ///< number of bytes that follow
};

struct MeshRequestHead {
  double scale[3] = {1, 1, 1};
  std::uint64_t base_memory = 0;  ///< memory for reading, for every size of the file [bytes]
  std::uint64_t memory_per_byte =
      0;  ///< additional memory for each byte of the mesh and its companions [bytes]
  std::uint64_t cpu_time = 0;   ///< processor time for this mesh [s]
  std::uint64_t name_size = 0;  ///< number of bytes of the name
};

/// Largest number of triangles of all parts of a mesh file. Chosen: at 96 bytes each they take 0.5
/// GB.
constexpr size_t kMostMeshTriangles = 5'000'000;

/// The first byte of MeshPart::texture_file in an encoded mesh. It says whether the name of a file
/// follows, as the mesh states it, or the bytes of a picture; an encoded mesh has no resolved path.
constexpr char kTextureName = 'n', kTextureBytes = 'b';

/// The mesh as bytes. The same mesh gives the same bytes.
std::string encode_mesh(const TriangleMesh& mesh);

/// The mesh in the bytes that a reader sent. The bytes are not trusted: every count is compared
/// with the number of remaining bytes before memory is allocated, every index is compared with the
/// number of vertices, every number has to be finite, and every normal has to be a unit vector.
/// Throws Error(bad_file) that says what is wrong.
TriangleMesh decode_mesh(std::string_view bytes);

}  // namespace ayumi
