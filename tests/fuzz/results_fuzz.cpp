// Results of push studies, and study files.

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/io/run/run_results.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const fuzz::InputFolder folder({{"", bytes}}, "push.json");
  fuzz::accepts([&] { read_push_thresholds(folder.path("push.json")); });
  fuzz::accepts([&] { study_of_text(bytes, folder.path("push.json")); });
  return 0;
}
