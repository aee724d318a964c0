// Sidecars with their URDF and with the bundled robots as bases.

#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const auto parts = fuzz::parts_of({reinterpret_cast<const char*>(data), size});
  const fuzz::InputFolder folder(parts, "robot.json");
  fuzz::accepts([&] { load_robot(folder.path("robot.json").string(), fuzz::bundled()); });
  return 0;
}
