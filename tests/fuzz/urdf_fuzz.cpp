// URDF files without a sidecar, for which values that are not stated are guessed.

#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const fuzz::InputFolder folder({{"", {reinterpret_cast<const char*>(data), size}}}, "robot.urdf");
  fuzz::accepts([&] { load_robot(folder.path("robot.urdf").string()); });
  return 0;
}
