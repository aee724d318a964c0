// Simulation logs.

#include "ayumi/io/run/simulation_log_file.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  SimulationLog log;
  if (!fuzz::accepts([&] { log = parse_log(bytes, "log.bin"); })) return 0;
  std::string written;
  fuzz::accepts([&] { written = log_bytes(log); });
  fuzz::expect(fuzz::accepts([&] { parse_log(written, "log.bin"); }),
               "a log that was written is read");
  return 0;
}
