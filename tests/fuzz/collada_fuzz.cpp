// The check of COLLADA files in the mesh reader, before assimp sees them.

#include "fuzz_target.hpp"
#include "lib/mesh_reader/collada_check.hpp"
#include "lib/mesh_reader/mesh_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    ayumi::mesh_reader::check_collada(bytes);
  } catch (const ayumi::mesh_reader::Refusal&) {
  }
  return 0;
}
