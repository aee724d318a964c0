// Mesh files, read by the confined reader, which Ayumi starts for each. The first line of an input
// is the name of the file. A file that breaks the reader gives one message.

#include "ayumi/io/robot/mesh.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const size_t line = all.find('\n');
  if (line == std::string_view::npos || line > 40) return 0;
  const std::string name(all.substr(0, line));
  if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789._") != std::string::npos ||
      !name.starts_with("mesh."))
    return 0;
  const fuzz::InputFolder folder({{"", std::string(all.substr(line + 1))}}, name);
  MeshReading reading;
  reading.cache.reset();
  fuzz::accepts([&] { load_mesh(folder.path(name), Eigen::Vector3d::Ones(), reading); });
  return 0;
}
