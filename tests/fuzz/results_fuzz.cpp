// Results of push studies, and study files.

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/io/run/run_results.hpp"
#include "ayumi/io/run/seal.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const fuzz::InputFolder folder({{"", bytes}}, "push.json");
  // The reader is reached behind the seal, which a mutated input does not have.
  if (bytes.find("\n}") != std::string::npos) {
    const fuzz::InputFolder whole({{"", sealed(bytes)}}, "push.json");
    fuzz::accepts([&] { read_push_thresholds(whole.path("push.json")); });
  }
  fuzz::accepts([&] { read_push_thresholds(folder.path("push.json")); });
  fuzz::accepts([&] { study_of_text(bytes, folder.path("push.json")); });
  return 0;
}
