// Answers of the mesh reader, which Ayumi does not trust. An accepted answer is the same after
// encoding and reading.

#include <cmath>

#include "ayumi/io/robot/mesh_message.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  TriangleMesh mesh;
  if (!fuzz::accepts([&] { mesh = decode_mesh(bytes); })) return 0;
  const std::string encoded = encode_mesh(mesh);
  fuzz::expect(encode_mesh(decode_mesh(encoded)) == encoded,
               "a mesh that was encoded and read is the same");
  return 0;
}
